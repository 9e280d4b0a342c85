// Enhanced sphere tracing (Keinert et al. 2014). Two balls around samples contain nothing of the solid. If they touch,
// the ray between their centres is free, however long the step was. If they do not, the step is taken back to the end
// of the first ball. Keinert et al. then go on with plain steps.
//
// planar = 1: the step of Bálint and Valasek (2018). The last two distances define a plane, if the surface is one. The
// step makes the next ball touch this one there. A step that fails is taken back, and only that one.
//
// The papers end a ray within the width of a pixel. Here a ray ends within a fiftieth of a texel, as by `circle`, so that the
// comparison is one of steps.

uint search(Meridian m, float side, float f, float pixel, inout float s, inout uint steps)
{
    float threshold = 0.02 * shape.texel;
    // Under a bevel F changes by up to 1 + b per object unit, so the empty ball is smaller.
    float shrink = 1.0 / (1.0 + (bool(BEVELED) ? abs(shape.bevel) : 0.0));
    float ball = 0.0;   // radius of the last ball, object units
    float stride = 0.0; // the last step
    float over = planar == 0 ? max(omega, 1.0) : omega;
    int most = most_steps();
    for (int i = 1; i < most; ++i) {
        float radius = f * shrink;
        if (stride > ball + radius && stride > ball) {
            // A gap between the balls: back to the end of the last one.
            s -= (stride - ball) * m.inverse_speed;
            stride = ball;
            over = planar == 0 ? 1.0 : over;
        } else {
            if (f < threshold || s > m.s_end) {
                break;
            }
            float next = radius * over;
            if (planar != 0) {
                float fall = max(stride + ball - radius, 1e-6); // negative cosines are longer than the step
                next = radius + over * radius * max(stride - ball + radius, 0.0) / fall;
                next = stride > 0.0 ? min(next, 8.0 * radius) : radius;
            }
            ball = radius;
            stride = next;
            s += stride * m.inverse_speed;
        }
        f = side * field(point_rz(m, s));
        ++steps;
    }
    if (s > m.s_end && f >= threshold) {
        return LEFT;
    }
    return f < threshold ? FOUND : f < shape.texel ? NEARLY : EXHAUSTED;
}
