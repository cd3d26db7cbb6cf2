/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/**
 * SECTION:gstdffcontext
 * @short_description: says which OpenCL device a pipeline computes on
 */
#include "gstdffcontext.h"

/**
 * gst_context_new_dff_device:
 * @device: part of the name of an OpenCL device, ignoring case, or "" for the first GPU, else the CPU
 *
 * Makes a context for gst_element_set_context(): all elements below that compute and whose property `device`
 * is empty then share this device. It is persistent, so that it holds until another one is set. A device that
 * is not there is an error when the elements start.
 *
 * Returns: (transfer full): the context
 *
 * Since: 0.1
 */
GstContext *gst_context_new_dff_device(const gchar *device)
{
    g_return_val_if_fail(device != NULL, NULL);

    GstContext *context = gst_context_new(GST_DFF_DEVICE_CONTEXT_TYPE, TRUE);
    gst_structure_set(gst_context_writable_structure(context), "device", G_TYPE_STRING, device, NULL);
    return context;
}
