// Where rays to far lights end.

float far_side(vec3 p) { return 2.0 * max(BALL.w, length(p - BALL.xyz)); }
