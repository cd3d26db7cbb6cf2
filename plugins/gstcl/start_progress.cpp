/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "gstcl/start_progress.h"

namespace dff {

namespace {

constexpr std::chrono::seconds patience{1};

void tell(GstElement *element, GstProgressType type, const char *text)
{
    gst_element_post_message(element, gst_message_new_progress(GST_OBJECT(element), type, "kernels", text));
}

} // namespace

StartProgress::StartProgress(GstElement *element)
    : element_(element), thread_([this](const std::stop_token &stop) { wait(stop); })
{
}

StartProgress::~StartProgress()
{
    thread_.request_stop();
    thread_.join();
    if (has_told_)
        tell(element_, GST_PROGRESS_TYPE_COMPLETE, "The wait for the first stack is over");
}

void StartProgress::wait(const std::stop_token &stop)
{
    std::unique_lock lock(mutex_);
    over_.wait_for(lock, stop, patience, [] { return false; });
    if (stop.stop_requested())
        return;
    tell(element_, GST_PROGRESS_TYPE_START,
         "Computing the first stack; the first time on a device, kernels are compiled, which takes some "
         "seconds");
    has_told_ = true;
}

} // namespace dff
