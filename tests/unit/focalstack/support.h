/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "../common/complaints.h"

#include <gst/check/gstharness.h>
#include <gst/dff/dff.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

/* Frames whose pixels say which plane of which sweep they are, and what is found in stacks. Linking this in
 * also calls gst_init(). */

struct Deleter {
    void operator()(GstBuffer *buffer) const { gst_buffer_unref(buffer); }
    void operator()(GstCaps *caps) const { gst_caps_unref(caps); }
    void operator()(GstMessage *message) const { gst_message_unref(message); }
    void operator()(GstHarness *harness) const { gst_harness_teardown(harness); }
    void operator()(GstStructure *structure) const { gst_structure_free(structure); }
};
template <typename T> using Owned = std::unique_ptr<T, Deleter>;

/* Duration of every test frame: 120 frames/s, rounded. */
constexpr GstClockTime frame_duration = GST_SECOND / 120;

GstVideoInfo video_info(const char *format, int width, int height);
std::string frame_caps(const char *format, int width, int height);

/* The byte every pixel of a plane consists of. */
uint8_t shade(uint64_t sweep, unsigned plane);

/* A frame of one shade. `planes` 0: without a meta. */
GstBuffer *new_frame(const GstVideoInfo &info, uint64_t sweep, unsigned plane, unsigned planes);

/* The first byte of each plane of a stack. */
std::vector<uint8_t> shades_of(const GstVideoInfo &info, GstBuffer *stack, unsigned planes);
std::vector<uint8_t> shades_of_sweep(uint64_t sweep, unsigned planes);

uint64_t count_of(GstElement *mux, const char *name);

/* Takes every message from the bus; how many of them are of a type. */
unsigned count_messages(GstBus *bus, GstMessageType type);
