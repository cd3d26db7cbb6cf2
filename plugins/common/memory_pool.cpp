/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "common/memory_pool.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <mutex>
#include <unistd.h>
#include <utility>
#include <vector>

namespace dff {

namespace {

constexpr size_t page = 4096;

struct Free {
    void operator()(std::byte *block) const { std::free(block); }
};
using Block = std::unique_ptr<std::byte, Free>;

/* What a file of the kernel's says of a container's memory; where there is no limit, or no number, a lot. */
uint64_t limit_in(const char *file)
{
    uint64_t bytes = 0;
    std::ifstream stream(file);
    return stream >> bytes ? bytes : std::numeric_limits<uint64_t>::max();
}

} // namespace

uint64_t largest_picture()
{
    const uint64_t machine =
        static_cast<uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<uint64_t>(sysconf(_SC_PAGESIZE));
    /* Control groups of version 2 and 1, as a container sees its own. */
    const uint64_t container = std::min(limit_in("/sys/fs/cgroup/memory.max"),
                                        limit_in("/sys/fs/cgroup/memory/memory.limit_in_bytes"));
    return std::min(machine, container) / 2;
}

class MemoryPool::Blocks {
public:
    Blocks(size_t bytes, size_t slack) : bytes_(bytes), slack_(slack) {}

    size_t bytes() const { return bytes_; }
    size_t slack() const { return slack_; }
    size_t size() const { return slack_ + bytes_ + slack_; }

    /* Empty if there is no memory. */
    Block take()
    {
        {
            const std::lock_guard lock(mutex_);
            if (!free_.empty()) {
                Block block = std::move(free_.back());
                free_.pop_back();
                return block;
            }
        }
        if (bytes_ > std::numeric_limits<size_t>::max() - 2 * slack_ - page)
            return nullptr;
        return Block(static_cast<std::byte *>(std::aligned_alloc(page, (size() + page - 1) / page * page)));
    }

    void give_back(Block block)
    {
        const std::lock_guard lock(mutex_);
        if (!closed_)
            free_.push_back(std::move(block));
    }

    /* Blocks that come back from now on are not kept. */
    void close()
    {
        const std::lock_guard lock(mutex_);
        closed_ = true;
        free_.clear();
    }

private:
    size_t bytes_;
    size_t slack_;
    std::mutex mutex_; /* a leaf; guards the rest */
    std::vector<Block> free_;
    bool closed_ = false;
};

struct MemoryPool::Lease {
    std::shared_ptr<Blocks> blocks;
    Block block;
};

MemoryPool::MemoryPool(size_t bytes, size_t slack) : blocks_(std::make_shared<Blocks>(bytes, slack)) {}

MemoryPool::~MemoryPool()
{
    blocks_->close();
}

size_t MemoryPool::bytes() const
{
    return blocks_->bytes();
}

GstMemory *MemoryPool::acquire()
{
    Block block = blocks_->take();
    if (!block)
        return nullptr;
    const size_t bytes = blocks_->bytes(), slack = blocks_->slack();
    std::memset(block.get(), 0, slack);
    std::memset(block.get() + slack + bytes, 0, slack);
    auto lease = std::make_unique<Lease>(Lease{blocks_, std::move(block)});
    std::byte *data = lease->block.get();
    constexpr int flags = GST_MEMORY_FLAG_ZERO_PREFIXED | GST_MEMORY_FLAG_ZERO_PADDED;
    return gst_memory_new_wrapped(static_cast<GstMemoryFlags>(flags), data, blocks_->size(), slack, bytes,
                                  lease.release(), [](gpointer data) {
                                      std::unique_ptr<Lease> ended(static_cast<Lease *>(data));
                                      ended->blocks->give_back(std::move(ended->block));
                                  });
}

} // namespace dff
