/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "sync_tagger.h"

SyncTagger::SyncTagger(std::unique_ptr<dff::EdgeLine> line, std::unique_ptr<dff::SequencedLens> sequencer,
                       const dff::SweepPlan &plan)
    : line_(std::move(line)), sequencer_(std::move(sequencer)), plan_(plan), cycle_(plan.planes())
{
}

void SyncTagger::begin(std::chrono::microseconds period)
{
    if (!sequencer_)
        return;
    sequencer_->stop();
    sequencer_->prepare({plan_, period});
    sequencer_->start();
}

std::optional<PlaneLabel> SyncTagger::label(std::optional<uint64_t> time_ns)
{
    /* The edge of a frame came as its exposure began, long before the frame: it waits in the kernel. */
    while (const auto edge = line_->read()) {
        cycle_.add_edge(edge->time_ns);
        edges_++;
    }
    if (sequencer_ && ++unchecked_ >= plan_.planes()) {
        sequencer_->check();
        unchecked_ = 0;
    }
    return time_ns ? cycle_.label(*time_ns) : std::nullopt;
}
