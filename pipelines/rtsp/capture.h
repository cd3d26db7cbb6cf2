/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "back_off.h"
#include "outlet.h"
#include "source_pipeline.h"

#include <gst/dff/dff.h>
#include <mutex>
#include <optional>
#include <thread>

namespace dff {

/* The one capture behind all mounts: runs the source while there are outlets, and starts it again, for ever,
 * when it fails or ends. All methods may be called by any thread. */
class Capture {
public:
    /* Throws as SourcePipeline. */
    explicit Capture(std::string launch);
    ~Capture();
    Capture(const Capture &) = delete;
    Capture &operator=(const Capture &) = delete;

    const std::set<std::string> &outputs() const { return outputs_; }

    /* From now on, the outlet gets the frames of an output. */
    void attach(const std::string &output, std::shared_ptr<Outlet> outlet);
    void detach(const std::shared_ptr<Outlet> &outlet);

    /* Whether there are outlets. */
    bool is_wanted() const;

    /* What the last frame of such an output said of its pixels; nothing before the first. */
    std::optional<GstDepthInfo> depth_info(const std::string &output) const;

private:
    /* These run in thread_. */
    void start_or_stop();
    void start();
    void restart_later(const std::string &reason);

    void publish(const std::string &output, const CapturedFrame &frame);

    const std::string launch_;
    std::set<std::string> outputs_;

    /* Guards the two below; held while outlets are pushed to, which take no lock that could be waiting for
     * it. */
    mutable std::mutex mutex_;
    std::multimap<std::string, std::shared_ptr<Outlet>> outlets_;
    std::map<std::string, GstDepthInfo> depth_infos_; /* by output */

    std::atomic<bool> delivered_{false}; /* whether the source gave a frame since it was last started */

    /* Touched in thread_ only. */
    std::unique_ptr<SourcePipeline> source_;
    BackOff back_off_;
    GSource *retry_ = nullptr;

    GMainContext *context_;
    GMainLoop *loop_;
    std::thread thread_;
};

} // namespace dff
