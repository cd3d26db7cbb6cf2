/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "capture.h"

#include <algorithm>

namespace dff {

namespace {

/* The facts of the pixels of a depth frame, from its meta or else from its caps. */
std::optional<GstDepthInfo> depth_info_of(const CapturedFrame &frame)
{
    GstDepthInfo info;
    gst_depth_info_init(&info);
    if (const GstDepthMeta *meta = gst_buffer_get_depth_meta(frame.buffer)) {
        gst_depth_meta_get_depth(meta, &info);
        return info;
    }
    return gst_depth_info_from_caps(&info, frame.caps) ? std::optional(info) : std::nullopt;
}

/* Calls `function` once in the thread of `context`, after `wait`. */
GSource *call_later(GMainContext *context, std::chrono::milliseconds wait, std::function<void()> function)
{
    GSource *source = g_timeout_source_new(static_cast<guint>(wait.count()));
    const GSourceFunc call = [](gpointer data) -> gboolean {
        (*static_cast<std::function<void()> *>(data))();
        return G_SOURCE_REMOVE;
    };
    const GDestroyNotify forget = [](gpointer data) { delete static_cast<std::function<void()> *>(data); };
    g_source_set_callback(source, call, new std::function<void()>(std::move(function)), forget);
    g_source_attach(source, context);
    return source;
}

void call_soon(GMainContext *context, std::function<void()> function)
{
    g_source_unref(call_later(context, std::chrono::milliseconds(0), std::move(function)));
}

void drop(GSource *&source)
{
    if (source) {
        g_source_destroy(source);
        g_source_unref(source);
        source = nullptr;
    }
}

} // namespace

Capture::Capture(std::string launch)
    : launch_(std::move(launch)), outputs_(SourcePipeline(launch_).outputs()), context_(g_main_context_new()),
      loop_(g_main_loop_new(context_, FALSE)), thread_([this] {
          g_main_context_push_thread_default(context_);
          g_main_loop_run(loop_);
          drop(retry_);
          source_.reset();
          g_main_context_pop_thread_default(context_);
      })
{
}

Capture::~Capture()
{
    call_soon(context_, [this] { g_main_loop_quit(loop_); });
    thread_.join();
    g_main_loop_unref(loop_);
    g_main_context_unref(context_);
}

void Capture::attach(const std::string &output, std::shared_ptr<Outlet> outlet)
{
    {
        const std::lock_guard lock(mutex_);
        outlets_.emplace(output, std::move(outlet));
    }
    call_soon(context_, [this] { start_or_stop(); });
}

void Capture::detach(const std::shared_ptr<Outlet> &outlet)
{
    {
        const std::lock_guard lock(mutex_);
        std::erase_if(outlets_, [&](const auto &entry) { return entry.second == outlet; });
    }
    call_soon(context_, [this] { start_or_stop(); });
}

std::optional<GstDepthInfo> Capture::depth_info(const std::string &output) const
{
    const std::lock_guard lock(mutex_);
    const auto found = depth_infos_.find(output);
    return found == depth_infos_.end() ? std::nullopt : std::optional(found->second);
}

bool Capture::is_wanted() const
{
    const std::lock_guard lock(mutex_);
    return !outlets_.empty();
}

void Capture::start_or_stop()
{
    const bool running = source_ || retry_;
    if (is_wanted() == running)
        return;
    if (!running)
        return start();
    drop(retry_);
    source_.reset();
    back_off_.succeeded();
    g_message("The last client is gone: the source is stopped");
}

void Capture::start()
{
    g_message("The source is started");
    delivered_ = false;
    source_.reset(); /* a failed one lets go of its camera before the next asks for it */
    source_ = std::make_unique<SourcePipeline>(launch_);
    source_->start(
        context_, [this](const std::string &output, const CapturedFrame &frame) { publish(output, frame); },
        [this](const std::string &reason) { restart_later(reason); });
}

void Capture::restart_later(const std::string &reason)
{
    if (delivered_)
        back_off_.succeeded();
    const auto wait = back_off_.next();
    g_warning("The source stopped: %s. It is started again in %.1f s", reason.c_str(),
              static_cast<double>(wait.count()) / 1000.0);
    retry_ = call_later(context_, wait, [this] {
        drop(retry_);
        start();
    });
}

void Capture::publish(const std::string &output, const CapturedFrame &frame)
{
    delivered_ = true;
    const std::lock_guard lock(mutex_);
    if (auto info = depth_info_of(frame)) {
        if (output == "uncertainty")
            info->offset = 0.0; /* a deviation is a difference */
        depth_infos_[output] = *info;
    }
    const auto [first, last] = outlets_.equal_range(output);
    std::for_each(first, last, [&](const auto &entry) { entry.second->push(frame); });
}

} // namespace dff
