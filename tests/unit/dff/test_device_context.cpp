/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "gstcl/device_context.h"
#include "test_pipeline.h"

#include <gtest/gtest.h>
#include <utility>

using dff::Device;
using dff::TestPipeline;

namespace {

const std::string graph =
    "lenssweeptestsrc num-buffers=12 ! video/x-raw,width=64,height=64 ! focalstackmux ! tee name=s  "
    "s. ! queue ! dffdepth name=d ! tee name=t  t. ! queue ! c.depth  s. ! queue ! c.stack  "
    "aifcompose name=c ! queue ! videoconvert ! video/x-raw,format=RGBx ! l.color  t. ! queue ! l.depth  "
    "lightfieldcompose name=l layout=rgbd ! appsink name=out sync=false";

/* Another than the one that elements open for themselves. */
std::shared_ptr<Device> other_device()
{
    /* Never destroyed: at the process's end the driver may have gone before it. */
    static const auto &device =
        *new std::shared_ptr<Device>(std::make_shared<Device>(Device::open("")->device()));
    return device;
}

/* The device that the element at the other end of this pad's link tells of. */
std::shared_ptr<Device> device_behind(GstElement *element, const char *pad_name)
{
    g_autoptr(GstPad) pad = gst_element_get_static_pad(element, pad_name);
    g_autoptr(GstQuery) query = gst_query_new_context(GST_DFF_DEVICE_CONTEXT_TYPE);
    if (!gst_pad_query(pad, query))
        return nullptr;
    GstContext *context = nullptr;
    gst_query_parse_context(query, &context);
    return dff::device_in(context);
}

void set_context(GstElement *element, const std::shared_ptr<Device> &device)
{
    g_autoptr(GstContext) context = dff::make_device_context(device);
    gst_element_set_context(element, context);
}

void set_context(GstElement *element, const char *device)
{
    g_autoptr(GstContext) context = gst_context_new_dff_device(device);
    gst_element_set_context(element, context);
}

void expect_pictures(const TestPipeline &pipeline, size_t count = 2)
{
    const std::vector<GstSample *> samples = pipeline.pull_all("out");
    EXPECT_EQ(samples.size(), count);
    for (GstSample *sample : samples)
        gst_sample_unref(sample);
}

} // namespace

TEST(DeviceContext, what_one_element_was_given_all_its_neighbours_use)
{
    TestPipeline pipeline(graph);
    const std::shared_ptr<Device> device = other_device();
    set_context(pipeline.element("d"), device);
    pipeline.play();
    expect_pictures(pipeline);
    for (const char *pad : {"sink", "src"})
        EXPECT_EQ(device_behind(pipeline.element("d"), pad), device) << pad;
    for (const char *pad : {"stack", "depth", "src"})
        EXPECT_EQ(device_behind(pipeline.element("c"), pad), device) << pad;
    EXPECT_EQ(device_behind(pipeline.element("l"), "color"), device);
}

TEST(DeviceContext, what_the_application_sets_on_the_pipeline_holds_for_all)
{
    TestPipeline pipeline(graph);
    const std::shared_ptr<Device> device = other_device();
    set_context(pipeline.bin(), device);
    pipeline.play();
    expect_pictures(pipeline);
    for (const char *name : {"d", "c", "l"})
        EXPECT_EQ(device_behind(pipeline.element(name), "src"), device) << name;
}

TEST(DeviceContext, the_application_is_asked_once_and_its_answer_is_used)
{
    struct Application {
        std::shared_ptr<Device> device = other_device();
        unsigned asked = 0, told = 0;
    } application;
    TestPipeline pipeline(graph);
    g_autoptr(GstBus) bus = gst_element_get_bus(pipeline.bin());
    gst_bus_set_sync_handler(
        bus,
        [](GstBus *, GstMessage *message, gpointer user) {
            auto &self = *static_cast<Application *>(user);
            const gchar *type = nullptr;
            self.told += GST_MESSAGE_TYPE(message) == GST_MESSAGE_HAVE_CONTEXT;
            if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_NEED_CONTEXT &&
                gst_message_parse_context_type(message, &type) &&
                g_str_equal(type, GST_DFF_DEVICE_CONTEXT_TYPE)) {
                self.asked++;
                set_context(GST_ELEMENT(GST_MESSAGE_SRC(message)), self.device);
            }
            return GST_BUS_PASS;
        },
        &application, nullptr);
    pipeline.play();
    expect_pictures(pipeline);
    EXPECT_EQ(application.asked, 1u) << "the others have it from their neighbours";
    EXPECT_EQ(application.told, 0u);
    EXPECT_EQ(device_behind(pipeline.element("c"), "src"), application.device);
    gst_bus_set_sync_handler(bus, nullptr, nullptr, nullptr);
}

TEST(DeviceContext, an_element_that_opens_a_device_tells_the_pipeline_until_it_stops)
{
    TestPipeline pipeline(graph);
    pipeline.play();
    expect_pictures(pipeline);
    {
        g_autoptr(GstContext) context = gst_element_get_context(pipeline.bin(), GST_DFF_DEVICE_CONTEXT_TYPE);
        ASSERT_NE(context, nullptr);
        EXPECT_EQ(dff::device_in(context), Device::open(""));
        EXPECT_EQ(gst_structure_get_string(gst_context_get_structure(context), "device"),
                  Device::open("")->name());
    }
    pipeline.stop();
    EXPECT_EQ(gst_element_get_context(pipeline.bin(), GST_DFF_DEVICE_CONTEXT_TYPE), nullptr);
    EXPECT_EQ(device_behind(pipeline.element("d"), "src"), nullptr);
    EXPECT_EQ(device_behind(pipeline.element("c"), "src"), nullptr);
}

TEST(DeviceContext, a_device_that_is_not_there_is_an_error_that_lists_those_that_are)
{
    TestPipeline pipeline(graph);
    set_context(pipeline.bin(), "no such device");
    pipeline.play();
    const std::string error = pipeline.wait().error;
    for (const std::string &part :
         {std::string(GST_DFF_DEVICE_CONTEXT_TYPE), std::string("no such device"), Device::open("")->name()})
        EXPECT_NE(error.find(part), std::string::npos) << error;
}

TEST(DeviceContext, a_context_without_a_device_is_an_error)
{
    TestPipeline pipeline(graph);
    g_autoptr(GstContext) context = gst_context_new(GST_DFF_DEVICE_CONTEXT_TYPE, TRUE);
    gst_element_set_context(pipeline.bin(), context);
    pipeline.play();
    const std::string error = pipeline.wait().error;
    EXPECT_NE(error.find("gst_context_new_dff_device"), std::string::npos) << error;
}

TEST(DeviceContext, the_property_wins_over_the_application)
{
    const std::string name = Device::open("")->name();
    TestPipeline other(graph), same(graph);
    for (TestPipeline *pipeline : {&other, &same})
        for (const char *element : {"d", "c", "l"})
            g_object_set(pipeline->element(element), "device", name.c_str(), nullptr);
    const std::shared_ptr<Device> device = other_device();
    set_context(other.bin(), "no such device");
    set_context(same.bin(), device);
    other.play();
    expect_pictures(other);
    EXPECT_EQ(device_behind(other.element("c"), "src"), Device::open(""));
    same.play();
    expect_pictures(same);
    EXPECT_EQ(device_behind(same.element("c"), "src"), device);
}

/* As where a program makes it by g_object_new(): the class knows its factory once that has made one. */
TEST(DeviceContext, an_element_that_no_factory_made_works_too)
{
    g_autoptr(GstElement) element =
        GST_ELEMENT(gst_object_ref_sink(gst_element_factory_make("aifcompose", nullptr)));
    GstElementFactory *factory = std::exchange(GST_ELEMENT_GET_CLASS(element)->elementfactory, nullptr);
    GstStructure *stats = nullptr;
    g_object_get(element, "stats", &stats, nullptr);
    EXPECT_STREQ(gst_structure_get_name(stats), "GstAifCompose-stats");
    gst_structure_free(stats);
    EXPECT_EQ(gst_element_set_state(element, GST_STATE_PAUSED), GST_STATE_CHANGE_FAILURE);
    gst_element_set_state(element, GST_STATE_NULL);
    GST_ELEMENT_GET_CLASS(element)->elementfactory = factory;
}

TEST(DeviceContext, names_its_device_where_it_is_printed)
{
    gst_init(nullptr, nullptr);
    const std::shared_ptr<Device> device = Device::open("");
    g_autoptr(GstContext) context = dff::make_device_context(device);
    g_autofree gchar *printed = gst_structure_to_string(gst_context_get_structure(context));
    EXPECT_EQ(std::string(printed).find("NULL"), std::string::npos) << printed;
}
