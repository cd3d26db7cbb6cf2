/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Included where constants slide with the noise.
 */

/* What a stack's noise decides, computed on the device by noise.cl: see NoiseEstimate. */
typedef struct {
    float sigma; /* DN, the least over the planes */
    float t;     /* sigma^2 / (sigma^2 + 1): 0 clean .. 1 noisy; constants slide with it */
    int taps[4]; /* of the pre-blur, in 1/64: centre and three to each side; taps[0] = 64 is none */
    int is_new;  /* the pre-blur is another than the last stack's */
} Noise;

/* Up to this t what is done against noise would change nothing and is left out. */
#define QUIET 0.1f
