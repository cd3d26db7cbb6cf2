/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "sync_tagger.h"

#include <cmath>

SyncTagger::SyncTagger(std::unique_ptr<dff::EdgeLine> line, std::unique_ptr<dff::SweptLens> lens,
                       const dff::SweepPlan &plan)
    : line_(std::move(line)), lens_(std::move(lens)), plan_(plan),
      cycle_(plan.planes(), lens_ && lens_->goes_to_and_fro())
{
    if (lens_ && lens_->goes_to_and_fro())
        check_.emplace(plan.planes());
}

void SyncTagger::begin(std::chrono::microseconds period)
{
    period_ = period;
    if (!lens_)
        return;
    lens_->stop();
    lens_->prepare({plan_, period});
    lens_->start();
}

std::optional<std::chrono::microseconds> SyncTagger::lag() const
{
    const auto lag = check_ ? check_->lag() : std::nullopt;
    if (!lag)
        return std::nullopt;
    return std::chrono::microseconds{std::llround(*lag * static_cast<double>(period_.count()))};
}

std::optional<PlaneLabel> SyncTagger::label(std::optional<uint64_t> time_ns,
                                            const std::function<SwingCheck::Sharpness()> &sharpness)
{
    /* The edge of a frame came as its exposure began, long before the frame: it waits in the kernel. */
    while (const auto edge = line_->read()) {
        cycle_.add_edge(edge->time_ns);
        edges_++;
    }
    if (lens_ && ++unchecked_ >= plan_.planes()) {
        lens_->check();
        unchecked_ = 0;
    }
    const auto label = time_ns ? cycle_.label(*time_ns) : std::nullopt;
    if (label && check_ && check_->wants(*label))
        check_->add(*label, sharpness());
    return label;
}
