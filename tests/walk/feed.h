/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "chance.h"

#include <atomic>
#include <condition_variable>
#include <deque>
#include <gst/dff/dff.h>
#include <gst/gst.h>
#include <mutex>
#include <string>
#include <thread>

namespace dff::walk {

/* What the inputs of an element agree on, as long as nobody wants them not to. */
struct Shape {
    int width = 64;
    int height = 64;
    int planes = 2;
};

/* A source pad with a thread of its own, linked to a sink pad of the element under test: frames, stacks or
 * depth, as the sink pad's template allows, mostly well formed. Used by one thread. */
class Feed {
public:
    /* Takes the pad's name for its own. */
    Feed(GstPad *sink, Chance &chance, const Shape &shape);
    ~Feed();
    Feed(const Feed &) = delete;
    Feed &operator=(const Feed &) = delete;

    GstPad *sink() const { return sink_; }
    const std::string &name() const { return name_; }

    /* To follow the element's state: a stream begins between READY and PAUSED, and ends there. */
    void start();
    void stop();

    /* These are queued for the thread. They return what they did. */
    std::string new_caps(const Shape &shape, bool well_formed);
    std::string push(unsigned buffers, bool well_formed);
    std::string gap();
    std::string new_segment();
    std::string end();

    /* Not queued: it comes between whatever else the feed is at. */
    std::string flush();

    /* How many seeks have flushed it. */
    unsigned flushing_seeks() const { return flushing_seeks_; }

private:
    void run();
    void push_item(GstMiniObject *item);
    void queue(GstMiniObject *item);
    void queue_stream_start();
    void queue_segment(GstFormat format, GstClockTime base);
    void clear_queue();
    void wait_idle();
    void flush(bool reset_time, guint32 seqnum);
    GstCaps *some_caps(const Shape &shape, bool well_formed);
    GstBuffer *some_buffer(bool well_formed);
    void add_meta(GstBuffer *buffer);
    gboolean handle_event(GstEvent *event);
    static gboolean event_function(GstPad *pad, GstObject *parent, GstEvent *event);

    Chance &chance_;
    GstPad *sink_;
    GstPad *pad_;
    std::string name_;
    GstCaps *caps_ = nullptr;
    std::atomic<bool> running_ = false; /* a stream, see start() */
    std::atomic<GstFlowReturn> flow_ = GST_FLOW_OK;
    std::uint64_t count_ = 0; /* of buffers */
    std::uint64_t sweep_base_ = 0;
    unsigned flushing_seeks_ = 0;
    GstFormat format_ = GST_FORMAT_TIME; /* of the last segment that was queued */

    std::mutex mutex_; /* guards what follows; nothing else is locked under it */
    std::condition_variable changed_;
    std::deque<GstMiniObject *> queue_;
    bool busy_ = false;
    bool over_ = false;
    std::thread thread_; /* last: it uses all of this */
};

} // namespace dff::walk
