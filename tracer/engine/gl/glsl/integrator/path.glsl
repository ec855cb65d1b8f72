// Path tracing: the twin of tracer/integrator/path.py, stage by stage, for one path.
// `direct` and `walk` are this loop with one of the two ways to find a light.

float mis_weight(float mine, float other)
{
    float ratio = other / mine;
#if POWER
    ratio *= ratio;
#endif
    return mine > 0.0 ? 1.0 / (1.0 + (ratio > 0.0 ? ratio : 0.0)) : 0.0;
}

// certain: from the camera and after a Dirac lobe, where no light sample could have been made.
float emission_weight(bool certain, float pdf_bsdf, float pdf_light)
{
#if STRATEGY == BY_BSDF
    return 1.0;
#elif STRATEGY == BY_LIGHT
    return certain ? 1.0 : 0.0;
#else
    return certain ? 1.0 : mis_weight(pdf_bsdf, pdf_light);
#endif
}

float light_weight(float pdf_light, float pdf_bsdf)
{
#if STRATEGY == BY_LIGHT
    return 1.0;
#else
    return mis_weight(pdf_light, pdf_bsdf);
#endif
}

float survival(vec3 beta, int depth)
{
#if ROULETTE == FIXED
    return said_survival;
#elif ROULETTE == AUTO
    return depth < AUTO_DEPTH ? 1.0 : min(max(max(beta.r, beta.g), beta.b), AUTO_MOST);
#else
    return 1.0;
#endif
}

vec3 trace(uint pixel, uint number, inout uint rays)
{
    vec3 beta = vec3(1.0), L = vec3(0.0), jitter = vec3(0.5), lens = vec3(0.0);
    float pdf_bsdf = 0.0;
    bool certain = true;
    int depth = 0;
#if MEDIA
    int medium = CAMERA_MEDIUM;
#endif
#if JITTER
    jitter = random(pixel, number, 0, FILM);
#endif
#if LENS
    lens = random(pixel, number, 0, LENS_USE);
#endif
    Ray r = Ray(vec3(0.0), vec3(0.0), -1, -1, 0.0, true);
    camera_ray(vec2(pixel & 0xFFFFu, pixel >> 16u) + jitter.xy, lens, r.o, r.d);
    vec3 vertex = r.o;
    if (last_depth < 0)
        return end(MAX_DEPTH, L);
    for (;; ++depth) {
        Near near = intersect(r);
        ++rays;
        if (near.primitive < 0) {
#if SURROUND
            L += beta * SKY_LE * emission_weight(certain, pdf_bsdf, SKY_PDF);
#endif
            return end(ESCAPED, L);
        }
        Hit hit = surface_hit(r, near);
#if MEDIA
        beta *= transmittance(medium, near.t);
#endif
#if TEXTURES
        hit.material = painted(hit);
#endif
        seen_vertex(depth, hit.primitive, hit.p);

        // Le: the surface itself shines, weighted against a light sample that would have found it
#if FACES
        if (hit.face >= 0 && dot(hit.ng, hit.wo) > 0.0) {
            Face face = faces_at(hit.face);
            float pdf_light = area_pdf(face, vertex, hit.p, hit.ng);
            L += beta * face.Le.rgb * emission_weight(certain, pdf_bsdf, pdf_light);
        }
#endif

        // Vertices that nothing can be added to
        if (depth >= last_depth)
            return end(MAX_DEPTH, L);
        Frame frame = surface_frame(hit);
        vec3 wo = to_local(frame, hit.wo);
        if (!reflects(hit.material, wo))
            return end(BLACK_END, L);

        // Direct light: w f Le V |cos| / p_light from one point on a light
#if STRATEGY != BY_BSDF && ENTRIES
        if (!is(hit.material, DELTA)) {
            LightSample light = sample_light(hit.p, random(pixel, number, depth, LIGHT));
            vec3 wi = to_local(frame, light.wi), f = bsdf_eval(hit.material, wo, wi);
#if ANY_SMOOTH
            f = sides_agree(hit, light.wi) ? f : vec3(0.0);
#endif
            float pdf = light.delta ? 0.0 : bsdf_pdf(hit.material, wo, wi);
            float w = light_weight(light.pdf, pdf);
            vec3 arriving = vec3(0.0);
            if (light.pdf > 0.0)
                arriving = beta * f * light.Le * (abs(wi.z) * w / light.pdf);
#if MEDIA
            arriving *= transmittance(towards(hit, light.wi, medium), length(light.q - hit.p));
#endif
            bool visible = false;
            if (any_channel(arriving)) {
                ++rays;
                visible = !occluded(hit, light);
                L += visible ? arriving : vec3(0.0);
            }
            seen_light(depth, visible);
        }
#endif
#if STRATEGY == BY_LIGHT && !ANY_DELTA
        if (depth + 1 >= last_depth)
            return end(MAX_DEPTH, L);
#endif

        // Indirect light: go where the BSDF chooses
        Sample s = bsdf_sample(hit.material, wo, random(pixel, number, depth, BSDF));
        vec3 wi = to_world(frame, s.wi);
#if ANY_SMOOTH
        s.f = sides_agree(hit, wi) ? s.f : vec3(0.0);
#endif
        if (!(s.pdf > 0.0) || !any_channel(s.f))
            return end(ABSORBED, L);
#if MEDIA
        if (!any_channel(beta))  // nothing got through to here
            return end(ABSORBED, L);
        medium = towards(hit, wi, medium);
#endif
        seen_bounce(depth, s.lobe);
        beta = beta * s.f * ((s.delta ? 1.0 : abs(s.wi.z)) / s.pdf);
        certain = s.delta;
        pdf_bsdf = s.pdf;
        float q = survival(beta, depth);
        if (q < 1.0) {
            if (!(random(pixel, number, depth, ROULETTE_USE).x < q))
                return end(ROULETTE_END, L);
            beta /= q;
        }
        r = spawn(hit, wi);
        vertex = hit.p;
    }
}
