/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "camera/camera_setup.h"
#include "sweep_properties.h"

#include <gst/gst.h>

/* The properties of lenssweepsrc that can be set, beside those of every sweep. */
struct CameraProperties {
    SweepProperties sweep;
    dff::CaptureSettings capture;
    GstClockTime trigger_timeout = GST_CLOCK_TIME_NONE;

    /* Throws std::invalid_argument, with a message for the user, if they describe no sweep. */
    dff::CaptureSettings settings() const;
};

/* The id of the one that is left to the element. */
enum { PROP_STATS = FIRST_OWN_PROPERTY };

void install_camera_properties(GObjectClass *klass);

/* False if the id is not one of them. */
bool set_camera_property(CameraProperties &properties, guint id, const GValue *value);
bool get_camera_property(const CameraProperties &properties, guint id, GValue *value);

void mark_camera_types();
