/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "fuzz.h"

#include <gst/dff/dff.h>

namespace {

/* What was taken must say the same when it is written and read again. */
template <typename Meta>
void read(GBytes *bytes, Meta *(*add)(GstBuffer *, GBytes *, GError **), GBytes *(*to_bytes)(const Meta *))
{
    g_autoptr(GstBuffer) buffer = gst_buffer_new();
    g_autoptr(GError) error = nullptr;
    const Meta *meta = add(buffer, bytes, &error);
    dff::require((meta == nullptr) == (error != nullptr));
    if (!meta)
        return;
    g_autoptr(GBytes) written = to_bytes(meta);
    g_autoptr(GstBuffer) other = gst_buffer_new();
    const Meta *again = add(other, written, nullptr);
    dff::require(again);
    g_autoptr(GBytes) twice = to_bytes(again);
    dff::require(g_bytes_equal(written, twice));
    g_autoptr(GstBuffer) copy = gst_buffer_copy(buffer);
    dff::require(copy);
}

} // namespace

extern "C" int LLVMFuzzerInitialize(int *, char ***)
{
    gst_init(nullptr, nullptr);
    g_log_set_always_fatal(static_cast<GLogLevelFlags>(G_LOG_LEVEL_CRITICAL | G_LOG_LEVEL_WARNING));
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    g_autoptr(GBytes) bytes = g_bytes_new(data, size);
    read(bytes, gst_buffer_add_focus_meta_from_bytes, gst_focus_meta_to_bytes);
    read(bytes, gst_buffer_add_focal_stack_meta_from_bytes, gst_focal_stack_meta_to_bytes);
    read(bytes, gst_buffer_add_depth_meta_from_bytes, gst_depth_meta_to_bytes);
    return 0;
}
