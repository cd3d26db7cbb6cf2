/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <string>
#include <vector>

namespace dff {

/* Where a lens stands when it focuses at an object vergence, for lenses whose positions are codes, currents
 * or in another unit of the maker's: points that somebody measured, from a file (optics/settings_file.h):
 *
 *   lens      name, for messages
 *   vergence  object vergences in dioptres (1 / metres), rising, two or more
 *   position  where the lens stands at each of them, rising or falling
 *   unit      of the positions, for messages; optional
 *
 * Between the points the position is on straight lines; beyond them nothing is known, and nothing is guessed.
 */
class FocusPoints {
public:
    /* Throws std::invalid_argument, with the file's name and the fault. */
    static FocusPoints load(const std::string &file);

    const std::string &lens() const { return lens_; }
    const std::string &unit() const { return unit_; }

    /* Object vergences in dioptres between which points were measured. */
    double nearest() const { return vergences_.back(); }
    double farthest() const { return vergences_.front(); }

    /* Throws std::invalid_argument, with the range, outside. */
    double position(double vergence) const;

private:
    FocusPoints() = default;

    std::string lens_;
    std::string unit_;
    std::vector<double> vergences_;
    std::vector<double> positions_;
};

} // namespace dff
