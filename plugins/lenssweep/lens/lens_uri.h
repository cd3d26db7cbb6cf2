/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>
#include <string>

namespace dff {

enum class LensKind { None, Fpga, Max14574, GenICam, V4l2, Element, Optotune };

/* What a lens is called. */
struct LensUri {
    LensKind kind = LensKind::None;
    std::string device;       /* fpga, max14574: an I2C bus; v4l2: a video device; optotune: a serial port */
    std::uint8_t address = 0; /* fpga, max14574: 7 bits */
    std::string feature; /* genicam: the camera's feature that focuses; element: the property that does */
    std::string element; /* element: the name of an element in the same pipeline */

    /* Reads "fpga:DEVICE@ADDRESS", "max14574:DEVICE@ADDRESS", "genicam:FEATURE", "v4l2:DEVICE",
     * "element:NAME.PROPERTY", "optotune:PORT" or "none"; an empty text is "none". "@ADDRESS" may be left out
     * for 0x3c and 0x77. Throws std::invalid_argument, with what is allowed, for everything else. */
    static LensUri parse(const std::string &text);
};

} // namespace dff
