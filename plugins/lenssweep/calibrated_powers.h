/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <string>
#include <vector>

/* The vergence of each plane by a file of dff-calibrate; empty without a file. Throws std::invalid_argument
 * and std::runtime_error, with a message for the user, if it does not say that or is of another number of
 * planes. */
std::vector<double> calibrated_powers(const std::string &file, unsigned planes);
