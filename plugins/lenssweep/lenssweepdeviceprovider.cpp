/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/**
 * SECTION:provider-lenssweepdeviceprovider
 * @title: lenssweepdeviceprovider
 * @short_description: lists the cameras that lenssweepsrc can take
 *
 * `gst-device-monitor-1.0 Source/Video` lists GigE Vision and USB3 Vision cameras; each makes a lenssweepsrc
 * that takes it. Looking for them sends a broadcast to each network.
 */
#include "lenssweepdeviceprovider.h"

#include "camera/camera_list.h"
#include "camera_caps.h"

struct _GstLensSweepDevice {
    GstDevice parent;
    gchar *id; /* constant */
};

struct _GstLensSweepDeviceProvider {
    GstDeviceProvider parent;
};

G_DEFINE_FINAL_TYPE(GstLensSweepDevice, gst_lens_sweep_device, GST_TYPE_DEVICE)
G_DEFINE_FINAL_TYPE(GstLensSweepDeviceProvider, gst_lens_sweep_device_provider, GST_TYPE_DEVICE_PROVIDER)
GST_DEVICE_PROVIDER_REGISTER_DEFINE(lenssweepdeviceprovider, "lenssweepdeviceprovider", GST_RANK_NONE,
                                    GST_TYPE_LENS_SWEEP_DEVICE_PROVIDER)

static GstElement *create_element(GstDevice *device, const gchar *name)
{
    GstElement *element = gst_element_factory_make("lenssweepsrc", name);
    if (element)
        g_object_set(element, "camera", GST_LENS_SWEEP_DEVICE(device)->id, nullptr);
    return element;
}

static gboolean reconfigure_element(GstDevice *device, GstElement *element)
{
    const GstElementFactory *factory = gst_element_get_factory(element);
    if (!factory || !g_str_equal(GST_OBJECT_NAME(factory), "lenssweepsrc"))
        return FALSE;
    g_object_set(element, "camera", GST_LENS_SWEEP_DEVICE(device)->id, nullptr);
    return TRUE;
}

static void finalize(GObject *object)
{
    g_free(GST_LENS_SWEEP_DEVICE(object)->id);
    G_OBJECT_CLASS(gst_lens_sweep_device_parent_class)->finalize(object);
}

static void gst_lens_sweep_device_init(GstLensSweepDevice *) {}

static void gst_lens_sweep_device_class_init(GstLensSweepDeviceClass *klass)
{
    G_OBJECT_CLASS(klass)->finalize = finalize;
    GST_DEVICE_CLASS(klass)->create_element = create_element;
    GST_DEVICE_CLASS(klass)->reconfigure_element = reconfigure_element;
}

static GstDevice *device_of(const dff::ListedCamera &camera)
{
    g_autoptr(GstCaps) caps = camera_template_caps();
    g_autoptr(GstStructure) properties = gst_structure_new(
        "lenssweep-camera", "device.api", G_TYPE_STRING, "aravis", "camera.id", G_TYPE_STRING,
        camera.id.c_str(), "camera.vendor", G_TYPE_STRING, camera.vendor.c_str(), "camera.model",
        G_TYPE_STRING, camera.model.c_str(), "camera.serial", G_TYPE_STRING, camera.serial.c_str(),
        "camera.address", G_TYPE_STRING, camera.address.c_str(), "camera.protocol", G_TYPE_STRING,
        camera.protocol.c_str(), nullptr);
    const std::string title = camera.vendor + " " + camera.model + " " + camera.serial;
    auto *device = GST_LENS_SWEEP_DEVICE(g_object_new(GST_TYPE_LENS_SWEEP_DEVICE, "display-name",
                                                      title.c_str(), "device-class", "Source/Video", "caps",
                                                      caps, "properties", properties, nullptr));
    device->id = g_strdup(camera.id.c_str());
    return GST_DEVICE(device);
}

static GList *probe(GstDeviceProvider *)
{
    GList *devices = nullptr;
    for (const dff::ListedCamera &camera : dff::list_cameras())
        devices = g_list_append(devices, gst_object_ref_sink(device_of(camera)));
    return devices;
}

static void gst_lens_sweep_device_provider_init(GstLensSweepDeviceProvider *) {}

static void gst_lens_sweep_device_provider_class_init(GstLensSweepDeviceProviderClass *klass)
{
    auto *provider_class = GST_DEVICE_PROVIDER_CLASS(klass);
    provider_class->probe = probe;
    gst_device_provider_class_set_static_metadata(provider_class, "Swept cameras", "Source/Video",
                                                  "Lists GenICam cameras that lenssweepsrc can take",
                                                  "the gst-plugins-dff authors");
}
