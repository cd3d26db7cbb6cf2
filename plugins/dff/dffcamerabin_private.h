/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

/* What the two files of dffcamerabin share: the element in dffcamerabin.cpp, its parts and pads in
 * dffcamerabin_graph.cpp. */
#include "camera_source.h"
#include "dffcamerabin.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

GST_DEBUG_CATEGORY_EXTERN(dff_camera_bin_debug);
#define GST_CAT_DEFAULT dff_camera_bin_debug

/* The parts of the graph. The bin owns the elements; one that is not installed is nullptr.
 *
 *   source ! planes ! mux ! stacks ! (depth_valve) ! queue ! denoise ! denoised
 *   denoised ! queue ! dffdepth ! depths ! queue ! pad depth
 *   denoised ! (stack_valve) ! queue ! aif.stack,  depths ! (aif_valve) ! queue ! aif.depth
 *   aifcompose ! pictures ! queue ! pad aif
 *
 * and, when their pads are requested,
 *
 *   pictures ! queue ! videoconvert ! light.color,  depths ! queue ! light.depth
 *   light ! queue ! pad lightfield
 *   planes ! queue ! pad planes,  stacks ! queue ! pad stacks
 *
 * A source of stacks goes straight to the tee stacks. A valve is shut while nobody wants what lies behind it.
 * The tees let the other branches go on when a pad is not linked. */
struct GstDffCameraBinState {
    std::string source_text = "lenssweeptestsrc"; /* under the object lock, as the source's thread reads it */
    std::string source_error;
    std::string missing; /* an element that is not installed, or empty */
    GstElement *source = nullptr;
    GstElement *planes = nullptr;
    GstElement *mux = nullptr;
    GstElement *stacks = nullptr;
    GstElement *depth_valve = nullptr;
    GstElement *denoise = nullptr;
    GstElement *denoised = nullptr;
    GstElement *stack_valve = nullptr;
    GstElement *aif_valve = nullptr;
    GstElement *dffdepth = nullptr;
    GstElement *depths = nullptr;
    GstElement *aifcompose = nullptr;
    GstElement *pictures = nullptr;
    std::map<std::string, std::vector<GstElement *>> requested; /* what a request pad needs, by its name */
    GstPad *depth_pad = nullptr;
    GstPad *aif_pad = nullptr;
    std::optional<dff::SourceRoute> route;
};

struct _GstDffCameraBin {
    GstBin parent;
    GstDffCameraBinState *state;
};

/* Makes the parts and the pads that are always there. What is not installed is told in `missing`. */
void gst_dff_camera_bin_build_graph(GstDffCameraBin *self);

/* GstElementClass.request_new_pad and release_pad */
GstPad *gst_dff_camera_bin_request_new_pad(GstElement *element, GstPadTemplate *pad_template,
                                           const gchar *name, const GstCaps *caps);
void gst_dff_camera_bin_release_pad(GstElement *element, GstPad *pad);

void gst_dff_camera_bin_add_pad_templates(GstElementClass *element_class);
