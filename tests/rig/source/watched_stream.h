/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <gst/app/app.h>
#include <gst/gst.h>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace dff {

/* What went through a stream of labelled frames. */
struct Watched {
    uint64_t frames = 0;
    uint64_t unlabelled = 0;
    uint64_t wrong = 0; /* the label is not that of the picture */
    std::string first_wrong;

    /* Of the last frame. */
    uint64_t exposure_ns = 0;
    int width = 0;
    double frame_rate = 0; /* as its caps say */
};

/* A pipeline that ends in "appsink name=labels", whose GRAY8 frames carry the bench camera's stamp: it holds
 * each label against what the picture truly is. */
class WatchedStream {
public:
    /* Throws std::runtime_error. */
    explicit WatchedStream(const std::string &pipeline);
    ~WatchedStream();
    WatchedStream(const WatchedStream &) = delete;
    WatchedStream &operator=(const WatchedStream &) = delete;

    GstElement *pipeline() const { return pipeline_.get(); }

    /* Sweeps are numbered anew each time. */
    void play();
    void stop() { gst_element_set_state(pipeline_.get(), GST_STATE_NULL); }

    /* False if that takes longer. It goes on then, and the process cannot end as it should. */
    bool stop_within(std::chrono::milliseconds time);

    Watched watched() const;

    /* False if there were not so many frames in time. */
    bool wait_for_frames(uint64_t count, std::chrono::milliseconds time) const;

    /* False if what went through did not become so in time. */
    bool wait_until(const std::function<bool(const Watched &)> &so, std::chrono::milliseconds time) const;

    /* Until no frame has come for so long. */
    void wait_for_silence(std::chrono::milliseconds silence) const;

    /* The text of the error or EOS on the bus; nothing if neither comes in time. */
    std::optional<std::string> wait_for_end(std::chrono::milliseconds time) const;

    /* A number from the source's `stats`. */
    uint64_t stat(const char *name) const;
    std::string stats() const;

private:
    struct Unref {
        void operator()(gpointer object) const { gst_object_unref(object); }
    };

    static GstFlowReturn new_sample(GstAppSink *sink, gpointer self);
    void examine(GstSample *sample);

    std::unique_ptr<GstElement, Unref> pipeline_;
    mutable std::mutex mutex_; /* guards all below */
    Watched watched_;
    std::map<uint64_t, uint32_t> true_sweeps_; /* of the sweeps that labels name */
};

} // namespace dff
