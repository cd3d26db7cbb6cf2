/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The roof: the greatest height in each block of BLOCK x BLOCK pixels, and behind those in each square of GROUP x GROUP blocks.
 * Rays above it fly over the block.
 */
#define BLOCK_BITS 4
#define BLOCK (1 << BLOCK_BITS)
#define BLOCKS(width) (((width) + BLOCK - 1) / BLOCK)
#define GROUP_BITS 2
#define GROUP (1 << GROUP_BITS)
#define GROUPS(width) ((BLOCKS(width) + GROUP - 1) / GROUP)

/* columns: as in light_field_layers.cl; pixels outside have no height. Work-items (blocks of a row, rows of them). */
__kernel void raise_roof(__global const float *height, int2 size, int2 columns, __global float *roof)
{
    const int block = (int)get_global_id(0), row = (int)get_global_id(1);
    if (block >= BLOCKS(size.x))
        return;
    float greatest = -INFINITY;
    for (int y = row * BLOCK; y < min((row + 1) * BLOCK, size.y); y++)
        for (int x = max(block * BLOCK, columns.x); x < min((block + 1) * BLOCK, columns.y); x++)
            greatest = max(greatest, height[(size_t)y * size.x + x]);
    roof[row * BLOCKS(size.x) + block] = greatest;
}

/* Work-items (groups of a row, rows of them). */
__kernel void join_roof(int2 size, __global float *roof)
{
    const int2 group = (int2)((int)get_global_id(0), (int)get_global_id(1)), blocks = BLOCKS(size);
    if (group.x >= GROUPS(size.x))
        return;
    float greatest = -INFINITY;
    for (int y = group.y * GROUP; y < min((group.y + 1) * GROUP, blocks.y); y++)
        for (int x = group.x * GROUP; x < min((group.x + 1) * GROUP, blocks.x); x++)
            greatest = max(greatest, roof[y * blocks.x + x]);
    roof[blocks.x * blocks.y + group.y * GROUPS(size.x) + group.x] = greatest;
}
