/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/stack_denoiser.h"

#include <gst/gst.h>

#include <string>

namespace dff {

/* What a user can set on focalstackdenoise. */
struct DenoiseSettings {
    DenoiseParameters parameters;
    bool local_motion = false;
    std::string device; /* part of its name, or empty */

    /* A single sweep without motion is passed on without a look at it. */
    bool ask_for_nothing() const { return parameters.frames == 1 && !local_motion; }
};

/* The properties of focalstackdenoise, from 1 to denoise_properties_end - 1. */
constexpr guint denoise_properties_end = 5;

void install_denoise_properties(GObjectClass *object_class);

/* False if `id` is not one of these properties. */
bool set_denoise_property(DenoiseSettings &settings, guint id, const GValue *value);
bool get_denoise_property(const DenoiseSettings &settings, guint id, GValue *value);

} // namespace dff
