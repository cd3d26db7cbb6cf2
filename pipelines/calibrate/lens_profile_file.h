/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace dff {

/* Writes a lens profile of points: where the lens stands when it focuses at these vergences. Throws
 * std::runtime_error with a user's text. */
void write_focus_points(const std::string &path, const std::string &lens, std::vector<double> vergences,
                        std::vector<double> positions);

/* Writes the lens profile of a rig whose planes lie at `vergences` with these codes. `like` is the file of
 * the liquid lens's profile that the codes were made with: the new one has its driver and times. Without it,
 * codes are where the lens stands. Throws std::runtime_error with a user's text. */
void write_lens_profile(const std::string &path, const std::string &lens,
                        const std::vector<double> &vergences, const std::vector<int> &codes,
                        const std::optional<std::string> &like);

} // namespace dff
