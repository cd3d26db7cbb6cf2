/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "warm_up.h"

#include "log.h"
#include "source_pipeline.h"

#include <gst/dff/dff.h>
#include <mutex>
#include <optional>
#include <stdexcept>

namespace dff {

namespace {

struct ContextUnref {
    void operator()(GMainContext *context) const { g_main_context_unref(context); }
};
using Context = std::unique_ptr<GMainContext, ContextUnref>;

/* What is wrong with the caps that an output gives; empty if nothing is. */
std::string fault_of(const std::string &output, const GstCaps *caps)
{
    g_autoptr(GError) error = nullptr;
    return gst_dff_capture_check_caps(output.c_str(), caps, &error) ? "" : error->message;
}

/* Outputs that have given no frame yet. Any thread. */
class SilentOutputs {
public:
    explicit SilentOutputs(std::set<std::string> names) : names_(std::move(names)) {}

    void remove(const std::string &name, GstCaps *caps)
    {
        const std::lock_guard lock(mutex_);
        if (names_.erase(name) == 0)
            return;
        GST_INFO("The output %s gives %" GST_PTR_FORMAT, name.c_str(), caps);
        if (fault_.empty())
            fault_ = fault_of(name, caps);
    }

    /* What is wrong with those that have; empty if nothing is. */
    std::string fault() const
    {
        const std::lock_guard lock(mutex_);
        return fault_;
    }

    bool empty() const
    {
        const std::lock_guard lock(mutex_);
        return names_.empty();
    }

private:
    mutable std::mutex mutex_;
    std::string fault_;
    std::set<std::string> names_;
};

} // namespace

void warm_up(const std::string &launch, std::chrono::seconds patience)
{
    const Context context(g_main_context_new());
    std::optional<std::string> failure;
    GSource *deadline = g_timeout_source_new_seconds(static_cast<guint>(patience.count()));
    const auto give_up = +[](gpointer reason) -> gboolean {
        *static_cast<std::optional<std::string> *>(reason) = "It gave no frame for too long";
        return G_SOURCE_REMOVE;
    };
    g_source_set_callback(deadline, give_up, &failure, nullptr);
    g_source_attach(deadline, context.get());
    g_source_unref(deadline);

    auto pipeline = std::make_unique<SourcePipeline>(launch);
    SilentOutputs silent(pipeline->outputs());
    pipeline->start(
        context.get(),
        [&](const std::string &output, const CapturedFrame &frame) {
            silent.remove(output, frame.caps);
            g_main_context_wakeup(context.get());
        },
        [&](const std::string &reason) { failure = reason; });
    while (!silent.empty() && !failure)
        g_main_context_iteration(context.get(), TRUE);
    pipeline.reset(); /* its threads use what stands above */
    if (const std::string fault = silent.fault(); !fault.empty())
        throw std::invalid_argument(fault);
    if (!silent.empty())
        g_warning("The source could not be tried: %s. Clients wait until it gives frames", failure->c_str());
}

} // namespace dff
