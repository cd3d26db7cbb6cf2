/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>
#include <gst/gst.h>
#include <memory>

namespace dff {

/* Bytes that a picture or stack may have on this machine: half of its memory, or of what its container may
 * use, since the next one is filled while one is on its way. */
uint64_t largest_picture();

/* Memories of one size for pictures and stacks, each used again when nobody has it any more. There are as
 * many as are asked for. Sizes have 64 bits, which those of GstBufferPool do not have, and a memory that
 * cannot be had does not end the process. Any thread; a memory may outlive its pool. */
class MemoryPool {
public:
    /* `slack` bytes at both ends of each memory, zeros, belong to it as its prefix and padding. */
    explicit MemoryPool(size_t bytes, size_t slack = 0);
    ~MemoryPool();
    MemoryPool(const MemoryPool &) = delete;
    MemoryPool &operator=(const MemoryPool &) = delete;

    size_t bytes() const;

    /* Its pages are not touched. nullptr if there is no memory. */
    GstMemory *acquire();

private:
    class Blocks;
    struct Lease;

    std::shared_ptr<Blocks> blocks_; /* those that are lent have it too */
};

} // namespace dff
