/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/* Looking for cameras sends a broadcast: everything here runs in a network namespace of its own. */
#include <arv.h>
#include <gst/gst.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <string>

namespace {

/* Before a thread is made, since threads inherit the namespace. */
const bool alone = unshare(CLONE_NEWNET) == 0 || unshare(CLONE_NEWUSER | CLONE_NEWNET) == 0;

class DeviceProvider : public testing::Test {
protected:
    void SetUp() override
    {
        if (!alone)
            GTEST_SKIP() << "no network namespace can be had here";
        gst_init(nullptr, nullptr);
    }
};

std::string error_of(const char *description)
{
    g_autoptr(GError) parse_error = nullptr;
    g_autoptr(GstElement) pipeline = gst_parse_launch(description, &parse_error);
    EXPECT_EQ(parse_error, nullptr);
    gst_element_set_state(pipeline, GST_STATE_PAUSED);
    g_autoptr(GstBus) bus = gst_element_get_bus(pipeline);
    g_autoptr(GstMessage) message = gst_bus_timed_pop_filtered(bus, 30 * GST_SECOND, GST_MESSAGE_ERROR);
    g_autoptr(GError) error = nullptr;
    if (message)
        gst_message_parse_error(message, &error, nullptr);
    gst_element_set_state(pipeline, GST_STATE_NULL);
    return error ? error->message : "";
}

} // namespace

TEST_F(DeviceProvider, a_camera_that_is_not_there_is_an_error_that_says_where_to_look)
{
    EXPECT_NE(error_of("lenssweepsrc ! fakesink").find("cable"), std::string::npos);
    EXPECT_NE(error_of("lenssweepsrc camera=Somebody-123 ! fakesink").find("Somebody-123"),
              std::string::npos);
}

TEST_F(DeviceProvider, lists_cameras_and_makes_sources_of_them)
{
    arv_enable_interface("Fake");
    g_autoptr(GstDeviceProvider) provider =
        gst_device_provider_factory_get_by_name("lenssweepdeviceprovider");
    ASSERT_NE(provider, nullptr);
    GList *devices = gst_device_provider_get_devices(provider);
    ASSERT_EQ(g_list_length(devices), 1U);
    auto *device = GST_DEVICE(devices->data);
    EXPECT_TRUE(gst_device_has_classes(device, "Source/Video"));
    g_autoptr(GstStructure) properties = gst_device_get_properties(device);
    EXPECT_STREQ(gst_structure_get_string(properties, "camera.vendor"), "Aravis");
    g_autoptr(GstElement) element = gst_device_create_element(device, nullptr);
    ASSERT_NE(element, nullptr);
    gst_object_ref_sink(element);
    g_autofree gchar *camera = nullptr;
    g_object_get(element, "camera", &camera, nullptr);
    EXPECT_STREQ(camera, gst_structure_get_string(properties, "camera.id"));
    g_list_free_full(devices, gst_object_unref);
    arv_disable_interface("Fake");
}
