/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/opencl/command_queue.h"

#include <functional>
#include <string>
#include <vector>

namespace dff::bench {

double median(std::vector<double> values);

/* Something that is timed: the whole of it, and its stages where it has some; all in ms. */
struct Row {
    enum class Kind { Copy, Ours, Part, Others };

    std::string name;
    Kind kind;
    unsigned every; /* rounds in which it runs once: slow ones need fewer */
    std::function<const StageTimes *()> work;
    std::vector<double> wall = {}, processor = {};
    std::vector<std::pair<std::string, std::vector<double>>> stages = {};

    void run();
};

} // namespace dff::bench
