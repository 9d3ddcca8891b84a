/* Arcs in closed form; see mars2d/physics/motion.py. */

#include <math.h>

#include "kernel.h"

/* The velocity that brings robot i, at heading theta, along its arc in h. */
Vector chord(const Kernel *k, int i, double theta, double h)
{
    int curved = k->team.in_robot_frame[i];
    double half = curved ? k->spin[i] * (h / 2) : 0.0;
    double turned = curved ? theta + half : 0.0;
    double shrink = half == 0.0 ? 1.0 : sin(half) / half;
    double c = shrink * cos(turned), s = shrink * sin(turned);
    double forward = k->forward[i], left = k->left[i];
    return (Vector){forward * c - left * s, forward * s + left * c};
}

void mars2d_kernel_sines(const double *angle, int count, double *sine, double *cosine, double *length)
{
    for (int i = 0; i < count; i++) {
        sine[i] = sin(angle[i]);
        cosine[i] = cos(angle[i]);
        length[i] = hypot(angle[i], sine[i]);
    }
}
