/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "lens.h"

#include <stdexcept>
#include <string>

/* What a lens says when it is used so; nothing if it does not mind. */
template <typename Use> std::string error_of(Use use)
{
    try {
        use();
    } catch (const dff::LensError &error) {
        return error.what();
    } catch (const std::invalid_argument &error) {
        return error.what();
    }
    return "";
}
