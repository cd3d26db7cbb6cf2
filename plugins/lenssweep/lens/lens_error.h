/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <stdexcept>

namespace dff {

/* The lens, or what drives it, does not do what it was told. The text is for the user and says what to do. */
class LensError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

} // namespace dff
