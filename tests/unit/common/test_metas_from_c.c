/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/* What an application in C does with the metas and contexts: it includes one header and links one library. */
#include <gst/dff/dff.h>

#undef NDEBUG
#include <assert.h>
#include <stdio.h>

int main(int argc, char *argv[])
{
    gst_init(&argc, &argv);

    GstBuffer *buffer = gst_buffer_new();
    GstFocusInfo focus;
    gst_focus_info_init(&focus);
    focus.sweep = 7;
    focus.plane = 3;
    focus.planes = 6;
    focus.power = 1.25;
    gst_buffer_add_focus_meta(buffer, &focus);
    assert(gst_buffer_get_focus_meta(buffer)->plane == 3);
    assert(gst_buffer_get_focus_meta(buffer)->power == 1.25);

    GstFocalStackMeta *stack = gst_buffer_add_focal_stack_meta(buffer, 12, 6);
    gst_focal_stack_meta_set_focus(stack, 3, &focus);
    assert(gst_focal_stack_meta_get_focus(stack, 3, &focus) && focus.sweep == 7);

    GstDepthInfo depth;
    gst_depth_info_init(&depth);
    depth.unit = GST_DEPTH_UNIT_DIOPTRE;
    gst_buffer_add_depth_meta(buffer, &depth);
    assert(gst_buffer_get_depth_meta(buffer)->unit == GST_DEPTH_UNIT_DIOPTRE);

    GstContext *context = gst_context_new_dff_device("GeForce");
    assert(gst_context_has_context_type(context, GST_DFF_DEVICE_CONTEXT_TYPE));
    gst_context_unref(context);

    gst_buffer_unref(buffer);
    gst_deinit();
    puts("ok");
    return 0;
}
