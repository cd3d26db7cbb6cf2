/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "stage_positions.h"
#include "sweep_properties.h"

#include <glib-object.h>
#include <string>

enum GstLensSweepTagMode {
    GST_LENS_SWEEP_TAG_MODE_CYCLE,
    GST_LENS_SWEEP_TAG_MODE_STEP,
    GST_LENS_SWEEP_TAG_MODE_SYNC
};

GType gst_lens_sweep_tag_mode_get_type();

/* The properties of lenssweeptag, but for its statistics. */
struct TagSettings {
    SweepProperties sweep{.near = 0.0, .far = 0.0, .powers = {}}; /* nobody invents distances */
    StagePositions stage;
    std::string calibration;
    GstLensSweepTagMode mode = GST_LENS_SWEEP_TAG_MODE_CYCLE;
    std::string lens = "none";
    std::string lens_profile;
    guint settle_frames = 1;
    std::string sync_line;
    guint64 timestamp_delay_ns = 0;
};

/* Ids of properties that are the element's alone begin here. */
constexpr guint first_id_after_tag_properties = FIRST_OWN_PROPERTY + 16;

void install_tag_properties(GObjectClass *klass);

/* False if there is no property of this id. */
bool set_tag_property(TagSettings &settings, guint id, const GValue *value);
bool get_tag_property(const TagSettings &settings, guint id, GValue *value);
