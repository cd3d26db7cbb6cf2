/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "gstcl/device_context.h"

#include "engine/engine_error.h"

#include <gst/dff/dff.h>

namespace dff {

namespace {

using SharedDevice = std::shared_ptr<Device>;

/* As in the contexts of GStreamer's own libraries, the open device's field has the name of the type. */
constexpr const char *open_device_field = GST_DFF_DEVICE_CONTEXT_TYPE, *name_field = "device";

GType register_shared_device()
{
    const GType type = g_boxed_type_register_static(
        "GstDffDevice",
        [](gpointer device) -> gpointer { return new SharedDevice(*static_cast<SharedDevice *>(device)); },
        [](gpointer device) { delete static_cast<SharedDevice *>(device); });
    /* For those who print a context. */
    g_value_register_transform_func(type, G_TYPE_STRING, [](const GValue *device, GValue *text) {
        const auto *shared = static_cast<const SharedDevice *>(g_value_get_boxed(device));
        g_value_set_string(text, shared ? (*shared)->name().c_str() : nullptr);
    });
    return type;
}

GType shared_device_type()
{
    static const GType type = register_shared_device();
    return type;
}

/* Throws EngineError. */
SharedDevice open_named_device(const GstContext *context)
{
    const gchar *name = gst_structure_get_string(gst_context_get_structure(context), name_field);
    if (!name)
        throw EngineError(EngineError::Kind::NoDevice,
                          "A GstContext " GST_DFF_DEVICE_CONTEXT_TYPE " names no device: make it with "
                          "gst_context_new_dff_device()");
    try {
        return Device::open(name);
    } catch (const EngineError &error) {
        throw EngineError(error.kind(), std::string("A GstContext " GST_DFF_DEVICE_CONTEXT_TYPE
                                                    " asks for another device than there is. ") +
                                            error.what());
    }
}

/* GStreamer's own for contexts. */
GstDebugCategory *context_category()
{
    GstDebugCategory *category = nullptr;
    GST_DEBUG_CATEGORY_GET(category, "GST_CONTEXT");
    return category;
}

gboolean ask_peer(GstElement *, GstPad *pad, gpointer query)
{
    return !gst_pad_peer_query(pad, static_cast<GstQuery *>(query)); /* until one answers */
}

} // namespace

GstContext *make_device_context(const std::shared_ptr<Device> &device)
{
    GstContext *context = gst_context_new(GST_DFF_DEVICE_CONTEXT_TYPE, FALSE);
    gst_structure_set(gst_context_writable_structure(context), open_device_field, shared_device_type(),
                      &device, name_field, G_TYPE_STRING, device->name().c_str(), nullptr);
    return context;
}

std::shared_ptr<Device> device_in(const GstContext *context)
{
    const GValue *value = gst_structure_get_value(gst_context_get_structure(context), open_device_field);
    if (!value || !G_VALUE_HOLDS(value, shared_device_type()))
        return nullptr;
    return *static_cast<SharedDevice *>(g_value_get_boxed(value));
}

std::shared_ptr<Device> DeviceContext::open(const std::string &wish)
{
    if (auto device = use_set(wish))
        return device;
    for (const GstPadDirection direction : {GST_PAD_SRC, GST_PAD_SINK})
        if (auto device = ask_neighbours(direction, wish))
            return device;
    gst_element_post_message(element_,
                             gst_message_new_need_context(GST_OBJECT(element_), GST_DFF_DEVICE_CONTEXT_TYPE));
    if (auto device = use_set(wish))
        return device;
    return use_own(wish);
}

void DeviceContext::close()
{
    const std::lock_guard lock(mutex_);
    gst_context_replace(&context_, nullptr);
}

std::shared_ptr<Device> DeviceContext::use_set(const std::string &wish)
{
    g_autoptr(GstContext) context = gst_element_get_context(element_, GST_DFF_DEVICE_CONTEXT_TYPE);
    return context ? use(context, wish) : nullptr;
}

std::shared_ptr<Device> DeviceContext::ask_neighbours(GstPadDirection direction, const std::string &wish)
{
    g_autoptr(GstQuery) query = gst_query_new_context(GST_DFF_DEVICE_CONTEXT_TYPE);
    const auto for_each_pad =
        direction == GST_PAD_SRC ? gst_element_foreach_src_pad : gst_element_foreach_sink_pad;
    for_each_pad(element_, ask_peer, query);

    GstContext *context = nullptr;
    gst_query_parse_context(query, &context);
    std::shared_ptr<Device> device = context ? use(context, wish) : nullptr;
    if (device)
        gst_element_set_context(element_, context);
    return device;
}

/* Empty if the context's device is not the one that is wished for. */
std::shared_ptr<Device> DeviceContext::use(GstContext *context, const std::string &wish)
{
    g_autoptr(GstContext) used = gst_context_ref(context);
    std::shared_ptr<Device> device = device_in(context);
    if (!device && wish.empty()) {
        device = open_named_device(context);
        gst_context_unref(used);
        used = make_device_context(device);
    }
    if (!device || !device->is_called(wish)) {
        GST_CAT_INFO_OBJECT(context_category(), element_,
                            "device=\"%s\" is another than that of %" GST_PTR_FORMAT, wish.c_str(), context);
        return nullptr;
    }
    GST_CAT_INFO_OBJECT(context_category(), element_, "using the device of %" GST_PTR_FORMAT, context);
    const std::lock_guard lock(mutex_);
    gst_context_replace(&context_, used);
    return device;
}

std::shared_ptr<Device> DeviceContext::use_own(const std::string &wish)
{
    std::shared_ptr<Device> device = Device::open(wish);
    g_autoptr(GstContext) context = make_device_context(device);
    gst_element_set_context(element_, context);
    {
        const std::lock_guard lock(mutex_);
        gst_context_replace(&context_, context);
    }
    gst_element_post_message(element_,
                             gst_message_new_have_context(GST_OBJECT(element_), gst_context_ref(context)));
    return device;
}

bool DeviceContext::answer(GstQuery *query) const
{
    const gchar *type = nullptr;
    if (GST_QUERY_TYPE(query) != GST_QUERY_CONTEXT || !gst_query_parse_context_type(query, &type) ||
        !g_str_equal(type, GST_DFF_DEVICE_CONTEXT_TYPE))
        return false;
    const std::lock_guard lock(mutex_);
    if (context_)
        gst_query_set_context(query, context_);
    return context_ != nullptr;
}

} // namespace dff
