/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "optics/lens_profile.h"

#include <array>
#include <cstdint>

namespace dff {

/* A driver chip of liquid lenses: what it is told, and how the sequencer in the FPGA does that. */
struct LensDriver {
    const char *name;
    double lowest; /* what code 0 stands for, as a lens profile has it: V rms, or a code */
    double highest;
    const char *unit;
    unsigned code_bits;
    std::array<std::uint16_t, 4> words; /* lens_address to lens_commit of the sequencer */

    /* The chip's code. Throws std::invalid_argument outside of lowest to highest. */
    std::uint16_t code(double drive) const;

    /* What the chip does with a code, as a lens profile has it. Throws std::invalid_argument for none of its
     * codes. */
    double drive(int code) const;

    /* The same in a row of the sequencer's table, whose codes have 10 bits: those of fewer are the high ones.
     */
    std::uint16_t table_code(double drive) const;

    bool direct() const; /* it takes a code in one write */
};

extern const LensDriver max14574_driver;
extern const LensDriver max14515_driver;

const LensDriver &driver_of(const LensProfile &profile);

} // namespace dff
