/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "lenssweep/lens/camera_features.h"

#include <stdexcept>
#include <string>

namespace dff {

/* A camera cannot be had or used. The text is for the user and says what to do. */
class CameraError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/* However it shows. */
inline constexpr const char *camera_gone =
    "The camera does not answer any more. Check its cable and power, then start again.";

/* What setting up a camera needs beyond what a lens needs. Throws as CameraFeatures does. */
class CameraControl : public CameraFeatures {
public:
    virtual bool get_boolean(const std::string &feature) = 0;
    virtual void set_boolean(const std::string &feature, bool value) = 0;

    /* Sets several, "Name=Value Name=Value", and executes commands, which have no value. */
    virtual void set_features(const std::string &text) = 0;
};

} // namespace dff
