/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Which of two things a cell is of where both are seen: what is thin and near is out of focus in the plane of what lies
 * behind it, which shows through. Planes are taken from the side that is wanted, near or far. A dip is a plane p from which C
 * rises to both sides by q / (T + q), as if focus fell by q = (.4 + .35t) med T + 1.5 + 2.5t, before it falls below
 * C_p again; the first plane may be one, too, and the last. With p the first dip, e the plane after it where C has risen so, and
 * another dip after e:
 *
 *     C_z <- max(C_z - C_p, 0) for z before e,  max(C_z, ELSEWHERE) from e on
 *
 * Costs are shorts in 1/COST_ONE, their sides mirrored; T is in 1/FOCUS_ONE DN. Work-items (1, low height).
 */
#include "low_picture.cl"

#define ELSEWHERE (short16)(short)(1.2f * COST_ONE)

#define CHOOSE(old, new, where) old = select(old, new, where)

__kernel void prefer(__global short *cost, __global const float *top, __global const float *median_top,
                     __global const Noise *noise, int from_far, int width, int stride, int planes)
{
    const size_t row = get_global_id(1) * stride + SIDE, plane = get_global_size(1) * stride;
    const float q = ((0.4f + 0.35f * noise->t) * *median_top + 1.5f + 2.5f * noise->t) * FOCUS_ONE;
    for (int x = 0; x < width; x += 16) {
        __global short *cells = cost + row + x;
#define COST(i) (cells + (size_t)(from_far ? planes - 1 - (i) : (i)) * plane)
        const short16 rise = to_wide_shorts(COST_ONE * q / (READ_WIDE(top + row + x) + q));
        short16 low = READ_SHORTS(COST(0)), high = low;  /* since the last turn */
        short16 falls = -1;                              /* whether a dip is looked for, not a rise's end */
        short16 floor = 0, end = (short16)(short)planes; /* C_p and e of the first dip */
        short16 dips = 0;                                /* -1 each, of at most two */
        for (int i = 1; i < planes; i++) {
            const short16 value = READ_SHORTS(COST(i));
            const short16 risen = falls & (value - low >= rise);
            const short16 first = risen & (dips == (short16)0);
            CHOOSE(floor, low, first);
            CHOOSE(end, (short16)(short)i, first);
            dips += first;
            falls &= ~risen;
            high = select(max(high, value), value, risen);
            const short16 fallen = ~falls & (high - value >= rise);
            falls |= fallen;
            low = select(min(low, value), value, fallen);
            dips += fallen & (dips == (short16)-1);
        }
        const short16 both = dips == (short16)-2;
        if (!any_of(convert_int16(both)))
            continue;
        for (int i = 0; i < planes; i++) {
            const short16 value = READ_SHORTS(COST(i)), is_before = (short16)(short)i < end;
            const short16 wanted = select(max(value, ELSEWHERE), max(value - floor, (short16)0), is_before);
            SHORTS(COST(i)) = select(value, wanted, both);
        }
    }
    for (int z = 0; z < planes; z++)
        mirror_short_ends(cost + z * plane + row, width);
}
