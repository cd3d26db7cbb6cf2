/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "chance.h"
#include "feed.h"
#include "story.h"

#include <gst/gst.h>
#include <memory>
#include <string>
#include <vector>

namespace dff::walk {

/* One element among feeds and fakesinks, taken through whatever an application may do to it in an order drawn
 * by the seed. */
class Walk {
public:
    Walk(const std::string &factory, std::uint64_t seed, Story &story);
    ~Walk();
    Walk(const Walk &) = delete;
    Walk &operator=(const Walk &) = delete;

    void step();

    /* Plays well-formed input to its end. False where neither the end nor an error comes out. */
    bool finishes();

    /* Lets the element go. False where somebody still holds it. */
    bool leaves();

private:
    void set_state(GstState state);
    void set_property();
    void read_properties();
    void feed_something();
    void change_caps();
    void seek();
    void seek(GstSeekFlags flags);
    void begin_anew();
    void request_pad();
    void release_pad();
    void ask();
    void add_feed(GstPad *pad);
    void add_sink(GstPad *pad);
    void take_messages();
    bool is_source() const;
    void say(const std::string &text) { story_.step(text); }

    Story &story_;
    Chance chance_;
    Shape shape_;
    GstElement *pipeline_;
    GstElement *element_;
    GstState state_ = GST_STATE_NULL;
    bool failed_ = false; /* an error was posted */
    std::vector<std::unique_ptr<Feed>> feeds_;
    std::vector<GstElement *> sinks_;
    std::vector<GstPad *> requested_;
};

} // namespace dff::walk
