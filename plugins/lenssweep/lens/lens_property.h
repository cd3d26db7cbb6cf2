/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "lens_error.h"

#include <string>
#include <utility>

namespace dff {

/* A property of an element of the pipeline by which a lens is moved. Every call but name() and is_integer()
 * throws LensError when the element is no longer there. */
class LensProperty {
public:
    virtual ~LensProperty() = default;

    /* What the user calls it: "cam.lens-position". */
    virtual std::string name() const = 0;

    virtual bool is_integer() const = 0;

    /* The least and the greatest value that it takes. */
    virtual std::pair<double, double> range() = 0;

    virtual double get() = 0;
    virtual void set(double value) = 0;

    /* Nobody but who calls set() moves the lens any more: an autofocus is switched off; and on again, if it
     * was. */
    virtual void take_over() = 0;
    virtual void give_back() = 0;
};

} // namespace dff
