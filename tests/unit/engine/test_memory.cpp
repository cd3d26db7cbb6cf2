/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/aif_composer.h"
#include "test_stack.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

using namespace dff;

namespace {

/* Memory with forbidden pages before and behind it, which begins or ends right at one of them. */
class GuardedMemory {
public:
    enum class Flush { Begin, End };

    GuardedMemory(size_t bytes, Flush flush) : page_(static_cast<size_t>(sysconf(_SC_PAGESIZE)))
    {
        const size_t usable = (bytes + page_ - 1) / page_ * page_;
        size_ = usable + 2 * page_;
        pages_ =
            static_cast<std::byte *>(mmap(nullptr, size_, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
        mprotect(pages_ + page_, usable, PROT_READ | PROT_WRITE);
        bytes_ = {pages_ + page_ + (flush == Flush::End ? usable - bytes : 0), bytes};
    }
    ~GuardedMemory() { munmap(pages_, size_); }
    GuardedMemory(const GuardedMemory &) = delete;
    GuardedMemory &operator=(const GuardedMemory &) = delete;

    std::span<std::byte> bytes() const { return bytes_; }

private:
    size_t page_, size_;
    std::byte *pages_;
    std::span<std::byte> bytes_;
};

} // namespace

class MemoryFormats : public testing::TestWithParam<PixelFormat> {};

/* A read or write outside of the pictures ends the test by a signal. */
TEST_P(MemoryFormats, nothing_outside_of_the_pictures_is_touched)
{
    for (const auto flush : {GuardedMemory::Flush::Begin, GuardedMemory::Flush::End}) {
        const StackShape shape{GetParam(), 67, 65, 3};
        const TestStack stack(shape);
        const GuardedMemory memory(stack.memory.size(), flush);
        std::copy(stack.memory.begin(), stack.memory.end(), memory.bytes().begin());
        const StackView view{shape, memory.bytes(), stack.layout};

        const GuardedMemory depth(67 * 65 * sizeof(uint16_t), flush);
        DepthOutputs outputs;
        outputs.depth = {depth.bytes().data(), 67 * sizeof(uint16_t)};
        for (const Method method : {Method::Paper, Method::Volume}) {
            DepthParameters parameters;
            parameters.method = method;
            FocusEngine engine(Device::open(""), shape, parameters);
            engine.compute(view, outputs);
        }

        const GuardedMemory picture(stack.memory.size() / 3, flush);
        const std::vector<RowLayout> layout = packed_layout({GetParam(), 67, 65, 1});
        AifComposer composer(Device::open(""), shape);
        for (const auto blend :
             {AifComposer::Blend::Linear, AifComposer::Blend::Soft, AifComposer::Blend::Sharp})
            composer.compose(view, {depth.bytes(), 67 * sizeof(uint16_t)}, blend, picture.bytes(), layout);
    }
}

/* The Gaussian of the largest cells reaches farther than the smallest picture. */
TEST(Memory, the_largest_cells_fit_the_smallest_picture)
{
    const StackShape shape{PixelFormat::Gray8, 64, 64, 2};
    const TestStack stack(shape);
    for (const KernelStyle style : {KernelStyle::Pixels, KernelStyle::Tiles}) {
        DepthParameters parameters;
        parameters.method = Method::Paper;
        parameters.grid.sigma_xy = parameters.grid.sigma_luma = 256;
        std::vector<uint16_t> depth(64 * 64);
        DepthOutputs outputs;
        outputs.depth = {std::as_writable_bytes(std::span(depth)).data(), 64 * sizeof(uint16_t)};
        FocusEngine engine(device_with(style), shape, parameters);
        EXPECT_TRUE(engine.compute(stack.view(), outputs));
        /* One cell: one depth. */
        EXPECT_LE(*std::max_element(depth.begin(), depth.end()) -
                      *std::min_element(depth.begin(), depth.end()),
                  64);
    }
}

INSTANTIATE_TEST_SUITE_P(Memory, MemoryFormats,
                         testing::Values(PixelFormat::Gray8, PixelFormat::Gray16, PixelFormat::I420,
                                         PixelFormat::Nv12, PixelFormat::Rgb, PixelFormat::Bgr,
                                         PixelFormat::Rgbx, PixelFormat::Bgrx, PixelFormat::Rgba64));
