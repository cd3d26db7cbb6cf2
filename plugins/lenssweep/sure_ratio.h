/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <optional>
#include <vector>

/* The part of `ways` that `changes` are, in the mean, for measurements one by one of both; what is left of
 * the changes is chance. Nothing unless the mean of the changes is four standard errors from 0, of twelve or
 * more. */
std::optional<double> sure_ratio(const std::vector<double> &changes, const std::vector<double> &ways);
