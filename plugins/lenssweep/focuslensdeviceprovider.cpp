/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/**
 * SECTION:provider-focuslensdeviceprovider
 * @title: focuslensdeviceprovider
 * @short_description: lists the lenses that lenssweeptag can move
 *
 * `gst-device-monitor-1.0 Filter/Video` lists V4L2 cameras and sub-devices whose focus can be set, and Lens
 * Drivers of Optotune; each makes a lenssweeptag that moves it. The property `launch` of a device is the
 * beginning of a pipeline; of a sub-device, whose camera libcamera has, one with libcamerasrc where that is
 * new enough. Lenses on an I2C bus do not tell of themselves.
 */
#include "focuslensdeviceprovider.h"

#include "lens/found_lenses.h"

struct _GstFocusLensDevice {
    GstDevice parent;
    gchar *uri; /* constant */
};

struct _GstFocusLensDeviceProvider {
    GstDeviceProvider parent;
};

G_DEFINE_FINAL_TYPE(GstFocusLensDevice, gst_focus_lens_device, GST_TYPE_DEVICE)
G_DEFINE_FINAL_TYPE(GstFocusLensDeviceProvider, gst_focus_lens_device_provider, GST_TYPE_DEVICE_PROVIDER)
GST_DEVICE_PROVIDER_REGISTER_DEFINE(focuslensdeviceprovider, "focuslensdeviceprovider", GST_RANK_NONE,
                                    GST_TYPE_FOCUS_LENS_DEVICE_PROVIDER)

static void give_lens(GstDevice *device, GstElement *element)
{
    g_object_set(element, "lens", GST_FOCUS_LENS_DEVICE(device)->uri, nullptr);
    gst_util_set_object_arg(G_OBJECT(element), "mode", "step");
}

static GstElement *create_element(GstDevice *device, const gchar *name)
{
    GstElement *element = gst_element_factory_make("lenssweeptag", name);
    if (element)
        give_lens(device, element);
    return element;
}

static gboolean reconfigure_element(GstDevice *device, GstElement *element)
{
    const GstElementFactory *factory = gst_element_get_factory(element);
    if (!factory || !g_str_equal(GST_OBJECT_NAME(factory), "lenssweeptag"))
        return FALSE;
    give_lens(device, element);
    return TRUE;
}

static void finalize(GObject *object)
{
    g_free(GST_FOCUS_LENS_DEVICE(object)->uri);
    G_OBJECT_CLASS(gst_focus_lens_device_parent_class)->finalize(object);
}

static void gst_focus_lens_device_init(GstFocusLensDevice *) {}

static void gst_focus_lens_device_class_init(GstFocusLensDeviceClass *klass)
{
    G_OBJECT_CLASS(klass)->finalize = finalize;
    GST_DEVICE_CLASS(klass)->create_element = create_element;
    GST_DEVICE_CLASS(klass)->reconfigure_element = reconfigure_element;
}

/* Whether libcamerasrc is there, and moves lenses. */
static bool libcamera_moves_lenses()
{
    g_autoptr(GstElementFactory) factory = gst_element_factory_find("libcamerasrc");
    g_autoptr(GstElement) source = factory ? gst_element_factory_create(factory, nullptr) : nullptr;
    if (!source)
        return false;
    gst_object_ref_sink(source);
    return g_object_class_find_property(G_OBJECT_GET_CLASS(source), "lens-position") != nullptr;
}

static std::string launch_line(const dff::FoundLens &lens)
{
    if (lens.kind == dff::FoundLens::Kind::Camera)
        return "v4l2src device=" + lens.device + " ! lenssweeptag mode=step lens=" + lens.uri;
    if (lens.kind == dff::FoundLens::Kind::Subdevice && libcamera_moves_lenses())
        return "libcamerasrc name=cam ! lenssweeptag mode=step lens=element:cam.lens-position";
    return "... ! lenssweeptag mode=step lens=" + lens.uri;
}

static GstDevice *device_of(const dff::FoundLens &lens)
{
    g_autoptr(GstCaps) caps = gst_caps_from_string("video/x-raw(ANY); video/x-bayer(ANY)");
    g_autoptr(GstStructure) properties = gst_structure_new(
        "focus-lens", "device.path", G_TYPE_STRING, lens.device.c_str(), "lens.name", G_TYPE_STRING,
        lens.name.c_str(), "lens.range", G_TYPE_STRING, lens.what.c_str(), "lens.uri", G_TYPE_STRING,
        lens.uri.c_str(), "launch", G_TYPE_STRING, launch_line(lens).c_str(), nullptr);
    const std::string title = (lens.name.empty() ? lens.device : lens.name) + ": " + lens.what;
    auto *device = GST_FOCUS_LENS_DEVICE(g_object_new(GST_TYPE_FOCUS_LENS_DEVICE, "display-name",
                                                      title.c_str(), "device-class", "Filter/Video", "caps",
                                                      caps, "properties", properties, nullptr));
    device->uri = g_strdup(lens.uri.c_str());
    return GST_DEVICE(device);
}

static GList *probe(GstDeviceProvider *)
{
    GList *devices = nullptr;
    for (const dff::FoundLens &lens : dff::find_lenses(dff::this_machine()))
        devices = g_list_append(devices, gst_object_ref_sink(device_of(lens)));
    return devices;
}

static void gst_focus_lens_device_provider_init(GstFocusLensDeviceProvider *) {}

static void gst_focus_lens_device_provider_class_init(GstFocusLensDeviceProviderClass *klass)
{
    auto *provider_class = GST_DEVICE_PROVIDER_CLASS(klass);
    provider_class->probe = probe;
    gst_device_provider_class_set_static_metadata(provider_class, "Lenses", "Filter/Video",
                                                  "Lists the lenses that lenssweeptag can move",
                                                  "the gst-plugins-dff authors");
}
