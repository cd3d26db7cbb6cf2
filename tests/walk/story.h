/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <string>
#include <vector>

namespace dff::walk {

/* What a walk has done so far, step by step, and a watch over it: a step that takes longer than a minute (or
 * DFF_WALK_PATIENCE seconds) prints the story and ends the process by SIGABRT, since a thread that hangs
 * cannot be taken back. One story at a time in a process. */
class Story {
public:
    explicit Story(std::string title);
    ~Story();
    Story(const Story &) = delete;
    Story &operator=(const Story &) = delete;

    /* A step begins. */
    void step(const std::string &text);

    std::string text() const;

    /* What GLib and GStreamer complained of since the story began, one line each. */
    static std::vector<std::string> complaints();
};

} // namespace dff::walk
