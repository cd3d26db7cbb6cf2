/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "depthio/dffmetadepay.h"
#include "fuzz.h"

#include <gst/check/gstharness.h>
#include <gst/dff/dff.h>
#include <sstream>

extern "C" int LLVMFuzzerInitialize(int *, char ***)
{
    gst_init(nullptr, nullptr);
    gst_element_register(nullptr, "dffmetadepay", GST_RANK_NONE, GST_TYPE_DFF_META_DEPAY);
    return 0;
}

/* What gdpdepay makes of a recording: an event of each line, as text, and a buffer at each empty one.
 * gdpdepay itself is left out, since that of GStreamer 1.22 dies of a damaged segment. */
extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    std::istringstream lines(std::string(reinterpret_cast<const char *>(data), size));
    GstHarness *harness = gst_harness_new("dffmetadepay");
    gst_harness_set_src_caps_str(harness, "x/y");
    std::string line;
    while (std::getline(lines, line)) {
        if (line.empty())
            gst_harness_push(harness, gst_buffer_new());
        else if (GstStructure *structure = gst_structure_from_string(line.c_str(), nullptr))
            gst_harness_push_event(harness, gst_event_new_custom(GST_EVENT_CUSTOM_DOWNSTREAM, structure));
    }
    while (GstBuffer *buffer = gst_harness_try_pull(harness))
        gst_buffer_unref(buffer);
    gst_harness_teardown(harness);
    return 0;
}
