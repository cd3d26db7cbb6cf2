/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <stdexcept>

namespace dff {

/* What a user can act on: the text says what is wrong and what to do. */
class EngineError : public std::runtime_error {
public:
    enum class Kind {
        NoDevice,    /* no OpenCL platform, or none that was asked for */
        TooLarge,    /* the stack does not fit the device */
        OutOfMemory, /* the device ran out of memory while working */
        Failed,      /* anything else the OpenCL driver said */
    };

    EngineError(Kind kind, const std::string &what) : std::runtime_error(what), kind_(kind) {}

    Kind kind() const { return kind_; }

private:
    Kind kind_;
};

} // namespace dff
