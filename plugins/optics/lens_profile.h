/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace dff {

/* The chip that drives a lens. */
enum class LensDriverKind { Max14574, Max14515 };

/* What a liquid lens is told to focus at an object vergence, from a file (optics/settings_file.h):
 *
 *   lens                name, for messages
 *   nominal             1: the figures are the maker's for lenses of this type; 0: measured on this lens
 *   power_at_infinity   optical power in dioptres of the liquid lens when the camera sees infinity sharply
 *   lens_power          optical powers in dioptres, rising, two or more
 *   driver              the chip that drives the lens, MAX14574 or MAX14515; optional, MAX14574
 *   volts               for a MAX14574: V rms at each of them, rising
 *   codes               for a MAX14515: its codes at each of them, rising, 0 to 255
 *   settle_us           time in microseconds from a new voltage or code until the lens rests
 *   overdrive           first code of a plane: this share of the step beyond it; optional, 0
 *   overdrive_delay_us  time in microseconds that the first code acts alone; optional, 0
 *
 * lens_power = vergence + power_at_infinity, thin lenses touching each other; what lies between the given
 * volts or codes is on straight lines.
 */
class LensProfile {
public:
    /* Throws std::invalid_argument, with the file's name and the fault. */
    static LensProfile load(const std::string &file);

    const std::string &lens() const { return lens_; }
    bool nominal() const { return nominal_; }

    /* Object vergences in dioptres that the lens reaches. */
    double nearest() const { return lens_powers_.back() - power_at_infinity_; }
    double farthest() const { return lens_powers_.front() - power_at_infinity_; }

    LensDriverKind driver() const { return driver_; }

    /* What the driver is told for an object vergence in dioptres: V rms, or a code, not rounded. Throws
     * std::invalid_argument, with the range, outside. */
    double drive(double vergence) const;

    std::chrono::microseconds settle() const { return settle_; }
    double overdrive() const { return overdrive_; }
    std::chrono::microseconds overdrive_delay() const { return overdrive_delay_; }

private:
    LensProfile() = default;

    std::string lens_;
    bool nominal_ = true;
    double power_at_infinity_ = 0;
    std::vector<double> lens_powers_;
    LensDriverKind driver_ = LensDriverKind::Max14574;
    std::vector<double> drives_; /* volts or codes */
    std::chrono::microseconds settle_{};
    double overdrive_ = 0;
    std::chrono::microseconds overdrive_delay_{};
};

} // namespace dff
