/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <stdexcept>

namespace dff {

/* A camera cannot be had or used. The text is for the user and says what to do. */
class CameraError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/* However it shows. */
inline constexpr const char *camera_gone =
    "The camera does not answer any more. Check its cable and power, then start again.";

} // namespace dff
