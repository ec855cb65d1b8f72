// Where rays begin: the twin of tracer/camera.py.

void camera_ray(vec2 film, vec3 lens, out vec3 o, out vec3 d)
{
    float x = (film.x * PER_PIXEL - 1.0) * HALF_WIDTH, y = (ASPECT - film.y * PER_PIXEL) * HALF_WIDTH;
    vec3 view = FORWARD + RIGHT * x + UP * y;
    o = ORIGIN;
#if LENS
    vec2 at = APERTURE_RADIUS * concentric_disk(lens.xy);
    vec3 aside = RIGHT * at.x + UP * at.y;
    o += aside;
    view = view * FOCUS_DISTANCE - aside;
#endif
    d = view / length(view);
}
