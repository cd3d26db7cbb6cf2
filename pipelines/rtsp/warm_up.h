/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <chrono>
#include <string>

namespace dff {

/* Runs a source pipeline until each of its outputs has given a frame. What takes long once, the kernels'
 * compilation above all, is done then, and the first client gets an answer within the 20 s that
 * gst-rtsp-server waits. A source that fails, ends or stays silent for `patience` is warned of and left to
 * those who start it next. Throws as SourcePipeline, also where an output's frames are not what its mounts
 * show. */
void warm_up(const std::string &launch, std::chrono::seconds patience);

} // namespace dff
