/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/aif_composer.h"
#include "engine/focus_engine.h"
#include "engine/opencl/shared_upload.h"
#include "test_stack.h"

#include <cstdlib>
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <new>

using namespace dff;

namespace {

/* What costs memory: buffers that are not the host's own, and blocks of the size of a picture or more. */
unsigned device_buffers = 0;
unsigned host_blocks = 0;
constexpr size_t picture_bytes = size_t{160} * 120;

} // namespace

/* Instead of the library's, which it calls. */
extern "C" cl_mem clCreateBuffer(cl_context context, cl_mem_flags flags, size_t size, void *memory,
                                 cl_int *error)
{
    static const auto real = reinterpret_cast<decltype(&clCreateBuffer)>(dlsym(RTLD_NEXT, "clCreateBuffer"));
    device_buffers += (flags & CL_MEM_USE_HOST_PTR) == 0;
    return real(context, flags, size, memory, error);
}

#if !defined(__SANITIZE_ADDRESS__) /* which has its own, and tells them apart */
/* Not inlined: g++ 14 would see malloc() given to another's operator delete, and warns. */
[[gnu::noinline]] void *operator new(size_t bytes)
{
    host_blocks += bytes >= picture_bytes;
    if (void *block = std::malloc(bytes ? bytes : 1))
        return block;
    throw std::bad_alloc();
}

[[gnu::noinline]] void operator delete(void *block) noexcept
{
    std::free(block);
}

[[gnu::noinline]] void operator delete(void *block, size_t) noexcept
{
    std::free(block);
}
#endif

/* How stacks come to the device. */
enum class Uploads { None, Own, Shared };

class SteadyState : public testing::TestWithParam<Method> {};

/* 20 stacks, one after the other, to depth and an all-in-focus picture. */
TEST_P(SteadyState, nothing_is_allocated_a_stack_whether_the_device_works_in_place_or_not)
{
    const StackShape shape{PixelFormat::I420, 160, 120, 6};
    const std::vector<TestStack> stacks{TestStack(shape, 1), TestStack(shape, 2), TestStack(shape, 3)};
    const std::vector<RowLayout> layout = packed_layout({shape.format, shape.width, shape.height, 1});
    std::vector<uint16_t> depth(picture_bytes);
    std::vector<uint8_t> confidence(picture_bytes), motion(picture_bytes);
    std::vector<std::byte> picture(stacks[0].memory.size() / shape.planes), reference;

    for (const Uploads uploads : {Uploads::None, Uploads::Own, Uploads::Shared}) {
        const auto device =
            std::make_shared<Device>(Device::open("")->device(), std::nullopt, uploads == Uploads::None);
        DepthParameters parameters;
        parameters.method = GetParam();
        FocusEngine engine(device, shape, parameters);
        AifComposer composer(device, shape);
        DepthOutputs outputs;
        outputs.depth = {std::as_writable_bytes(std::span(depth)).data(), shape.width * sizeof(uint16_t)};
        outputs.confidence = {std::as_writable_bytes(std::span(confidence)).data(), shape.width};
        outputs.motion = {std::as_writable_bytes(std::span(motion)).data(), shape.width};

        for (unsigned k = 0; k < 20; k++) {
            if (k == 10)
                device_buffers = host_blocks = 0;
            StackView view = stacks[k % stacks.size()].view();
            if (uploads == Uploads::Shared)
                view.upload = std::make_shared<SharedUpload>();
            engine.compute(view, outputs);
            composer.compose(view, {std::as_bytes(std::span(depth)), shape.width * sizeof(uint16_t)},
                             AifComposer::Blend::Soft, picture, layout);
        }
        EXPECT_EQ(device_buffers, 0u);
        EXPECT_EQ(host_blocks, 0u);
        if (reference.empty())
            reference = picture;
        EXPECT_EQ(picture, reference);
    }
}

INSTANTIATE_TEST_SUITE_P(Engine, SteadyState, testing::Values(Method::Paper, Method::Volume));

TEST(UploadPool, buffers_take_a_quarter_of_the_devices_memory_and_are_used_again)
{
    const size_t bytes = 4096;
    const auto pool = std::make_shared<UploadPool>(Device::open("")->context(), bytes, 8 * bytes);
    std::shared_ptr<cl::Buffer> one = pool->take(), two = pool->take();
    ASSERT_TRUE(one && two);
    EXPECT_EQ(pool->take(), nullptr);
    const cl_mem first = (*one)();
    one.reset();
    one = pool->take();
    ASSERT_TRUE(one);
    EXPECT_EQ((*one)(), first);
}
