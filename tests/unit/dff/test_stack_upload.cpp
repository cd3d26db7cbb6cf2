/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "gstcl/device_context.h"
#include "test_pipeline.h"

#include <algorithm>
#include <atomic>
#include <dlfcn.h>
#include <gtest/gtest.h>

using dff::Device;
using dff::TestPipeline;

namespace {

/* 96x64 GRAY8, 6 planes: no other buffer has this size. */
constexpr size_t stack_bytes = 36864;
constexpr unsigned stacks = 3;

/* Stacks that were copied to a device, and the buffers made for them. */
std::atomic<unsigned> uploads = 0, stack_buffers = 0;

} // namespace

/* Instead of the library's, which they call. */
extern "C" cl_int clEnqueueWriteBuffer(cl_command_queue queue, cl_mem buffer, cl_bool blocking, size_t offset,
                                       size_t size, const void *memory, cl_uint events_count,
                                       const cl_event *events, cl_event *event)
{
    static const auto real =
        reinterpret_cast<decltype(&clEnqueueWriteBuffer)>(dlsym(RTLD_NEXT, "clEnqueueWriteBuffer"));
    uploads += size == stack_bytes;
    return real(queue, buffer, blocking, offset, size, memory, events_count, events, event);
}

extern "C" cl_mem clCreateBuffer(cl_context context, cl_mem_flags flags, size_t size, void *memory,
                                 cl_int *error)
{
    static const auto real = reinterpret_cast<decltype(&clCreateBuffer)>(dlsym(RTLD_NEXT, "clCreateBuffer"));
    stack_buffers += size == stack_bytes && (flags & CL_MEM_USE_HOST_PTR) == 0;
    return real(context, flags, size, memory, error);
}

namespace {

using Pictures = std::vector<std::vector<guint8>>;

/* What appsink "out" gets of this pipeline to its end. */
Pictures pictures_of(const TestPipeline &pipeline, const char *sink = "out")
{
    Pictures pictures;
    for (GstSample *sample : pipeline.pull_all(sink)) {
        GstMapInfo map;
        gst_buffer_map(gst_sample_get_buffer(sample), &map, GST_MAP_READ);
        pictures.emplace_back(map.data, map.data + map.size);
        gst_buffer_unmap(gst_sample_get_buffer(sample), &map);
        gst_sample_unref(sample);
    }
    return pictures;
}

const std::string sweeps = "lenssweeptestsrc name=source num-buffers=18 planes=6 motion=2 ! "
                           "video/x-raw,width=96,height=64,format=GRAY8 ! focalstackmux ! tee name=s  ";
const std::string small_queue = "queue max-size-buffers=1";

/* As in the README. */
const std::string graph = sweeps + "s. ! " + small_queue + " ! dffdepth ! queue ! c.depth  s. ! " +
                          small_queue + " name=q ! c.stack  aifcompose name=c ! appsink name=out sync=false";

enum class Memory { InPlace, Discrete };

/* PoCL works in place by itself. */
std::shared_ptr<Device> discrete_device()
{
    return std::make_shared<Device>(Device::open("")->device(), std::nullopt, false);
}

void set_device(GstElement *element, const std::shared_ptr<Device> &device)
{
    g_autoptr(GstContext) context = dff::make_device_context(device);
    gst_element_set_context(element, context);
}

void start(TestPipeline &pipeline, Memory kind)
{
    /* Never destroyed: at the process's end the driver may have gone before it. */
    static const auto &discrete = *new std::shared_ptr<Device>(discrete_device());
    set_device(pipeline.bin(), kind == Memory::InPlace ? Device::open("") : discrete);
    uploads = stack_buffers = 0;
    pipeline.play();
}

/* On the way to aifcompose each stack goes through `change`. */
void change_stacks(const TestPipeline &pipeline, GstBuffer *(*change)(GstBuffer *stack))
{
    g_autoptr(GstPad) pad = gst_element_get_static_pad(pipeline.element("q"), "src");
    gst_pad_add_probe(
        pad, GST_PAD_PROBE_TYPE_BUFFER,
        [](GstPad *, GstPadProbeInfo *info, gpointer user) {
            info->data = reinterpret_cast<GstBuffer *(*)(GstBuffer *)>(user)(GST_BUFFER(info->data));
            return GST_PAD_PROBE_OK;
        },
        reinterpret_cast<gpointer>(change), nullptr);
}

/* As an element that works in place, once the others are done with the stack. */
GstBuffer *invert(GstBuffer *stack)
{
    for (int i = 0; i < 3000 && GST_MINI_OBJECT_REFCOUNT_VALUE(stack) > 1; i++)
        g_usleep(G_USEC_PER_SEC / 100);
    EXPECT_TRUE(gst_buffer_is_writable(stack));
    GstMapInfo map;
    EXPECT_TRUE(gst_buffer_map(stack, &map, GST_MAP_READWRITE));
    for (gsize i = 0; i < map.size; i++)
        map.data[i] = static_cast<guint8>(255 - map.data[i]);
    gst_buffer_unmap(stack, &map);
    return stack;
}

/* As an element that changes times or metas only. */
GstBuffer *copy_metadata(GstBuffer *stack)
{
    GstBuffer *copy = gst_buffer_copy(stack);
    EXPECT_EQ(gst_buffer_peek_memory(copy, 0), gst_buffer_peek_memory(stack, 0));
    gst_buffer_unref(stack);
    return copy;
}

} // namespace

TEST(StackUpload, depth_and_picture_need_one_a_stack)
{
    TestPipeline in_place(graph), discrete(graph);
    start(in_place, Memory::InPlace);
    const Pictures expected = pictures_of(in_place);
    ASSERT_EQ(expected.size(), stacks);
    EXPECT_EQ(uploads, 0u);
    EXPECT_EQ(stack_buffers, 0u);

    start(discrete, Memory::Discrete);
    EXPECT_EQ(pictures_of(discrete), expected);
    EXPECT_EQ(uploads, stacks);
}

TEST(StackUpload, no_more_buffers_are_made_than_stacks_are_under_way)
{
    TestPipeline pipeline(graph);
    g_object_set(pipeline.element("source"), "num-buffers", 60, nullptr);
    start(pipeline, Memory::Discrete);
    EXPECT_EQ(pictures_of(pipeline).size(), 10u);
    EXPECT_EQ(uploads, 10u);
    EXPECT_LE(stack_buffers, 6u);
}

TEST(StackUpload, a_stack_changed_in_place_is_never_shown_as_it_was)
{
    TestPipeline in_place(graph), discrete(graph), unchanged(graph);
    change_stacks(in_place, invert);
    change_stacks(discrete, invert);
    start(in_place, Memory::InPlace);
    const Pictures expected = pictures_of(in_place);
    start(discrete, Memory::Discrete);
    EXPECT_EQ(pictures_of(discrete), expected);
    EXPECT_EQ(uploads, 2 * stacks);
    start(unchanged, Memory::Discrete);
    EXPECT_NE(pictures_of(unchanged), expected);
}

TEST(StackUpload, a_copy_of_the_metadata_alone_shares_it)
{
    TestPipeline in_place(graph), discrete(graph);
    change_stacks(discrete, copy_metadata);
    start(in_place, Memory::InPlace);
    const Pictures expected = pictures_of(in_place);
    start(discrete, Memory::Discrete);
    EXPECT_EQ(pictures_of(discrete), expected);
    EXPECT_EQ(uploads, stacks);
}

TEST(StackUpload, elements_that_start_on_it_at_once_share_it)
{
    TestPipeline pipeline(sweeps + "s. ! " + small_queue +
                          " ! dffdepth ! appsink name=one sync=false  s. ! " + small_queue +
                          " ! dffdepth ! appsink name=two sync=false");
    start(pipeline, Memory::Discrete);
    const Pictures one = pictures_of(pipeline, "one");
    EXPECT_EQ(one.size(), stacks);
    EXPECT_EQ(pictures_of(pipeline, "two"), one);
    EXPECT_EQ(uploads, stacks);
}

TEST(StackUpload, devices_have_one_each)
{
    TestPipeline pipeline(sweeps + "s. ! queue ! dffdepth name=d ! appsink name=one sync=false  "
                                   "s. ! queue ! dffdepth name=e ! appsink name=two sync=false");
    for (const char *name : {"d", "e"})
        set_device(pipeline.element(name), discrete_device());
    uploads = 0;
    pipeline.play();
    const Pictures one = pictures_of(pipeline, "one");
    EXPECT_EQ(one.size(), stacks);
    EXPECT_EQ(pictures_of(pipeline, "two"), one);
    EXPECT_EQ(uploads, 2 * stacks);
}

TEST(StackUpload, without_metas_each_element_has_its_own)
{
    const std::string file = dff::write_file("stack", dff::gray_stack(96, 64, 6, 2));
    TestPipeline pipeline(
        "multifilesrc num-buffers=3 location=" + file +
        " caps=\"video/x-focal-stack,format=GRAY8,width=96,height=64,planes=6,framerate=1/1\" ! "
        "tee name=s  s. ! queue ! dffdepth ! queue ! c.depth  s. ! queue ! c.stack  "
        "aifcompose name=c ! appsink name=out sync=false");
    start(pipeline, Memory::Discrete);
    EXPECT_EQ(pictures_of(pipeline).size(), stacks);
    EXPECT_EQ(uploads, 2 * stacks);
    EXPECT_EQ(stack_buffers, 2u);
}

TEST(StackUpload, a_stack_kept_past_the_pipelines_end_is_valid)
{
    g_autoptr(GstSample) kept = nullptr;
    {
        TestPipeline pipeline(sweeps + "s. ! queue ! dffdepth ! appsink name=out sync=false  "
                                       "s. ! queue ! appsink name=stacks sync=false");
        start(pipeline, Memory::Discrete);
        kept = pipeline.pull("stacks");
        EXPECT_EQ(pictures_of(pipeline).size(), stacks);
    }
    ASSERT_NE(kept, nullptr);
    GstMapInfo map;
    ASSERT_TRUE(gst_buffer_map(gst_sample_get_buffer(kept), &map, GST_MAP_READ));
    EXPECT_EQ(map.size, stack_bytes);
    EXPECT_NE(std::count(map.data, map.data + map.size, map.data[0]), static_cast<std::ptrdiff_t>(map.size));
    gst_buffer_unmap(gst_sample_get_buffer(kept), &map);
}
