/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "label_watch.h"

#include <algorithm>

namespace dff {

namespace {

/* More than it takes to find out which trigger is which frame's, be it twice. */
constexpr unsigned sweeps_without_label = 20;
constexpr unsigned dropped_in_a_row = 10;

const char *what_to_check(Unlabelled reason)
{
    switch (reason) {
    case Unlabelled::Incomplete:
        return "packets of them are missing. Check that the network takes packets of this size (MTU), that "
               "the "
               "link is fast enough and carries nothing else, and that this machine keeps up";
    case Unlabelled::Invalid:
        return "the camera numbers them in a way that is not known here";
    case Unlabelled::Doubled:
        return "the camera gives the same number again and again";
    case Unlabelled::NoTrigger:
        return "no edge of sync-line came with them. Check that it is wired, and that the sequencer pulses "
               "it at "
               "plane 0 of each sweep";
    case Unlabelled::Seeking:
    case Unlabelled::Disagree:
        break;
    }
    return "they do not fit the triggers. Check that planes and rate are those of the sequencer, and that "
           "the "
           "camera takes every trigger (exposure, TriggerOverlap). One that heeds no trigger, as most "
           "simulated "
           "cameras, needs trigger=free-run";
}

} // namespace

void LabelWatch::labelled(const FrameLabel &label)
{
    unlabelled_in_row_ = 0;
    labels_ = label.sweep == sweep_ ? labels_ + 1 : 1;
    sweep_ = label.sweep;
    if (labels_ < planes_)
        return;
    reasons_.fill(0);
    dropped_in_row_ = 0;
}

void LabelWatch::judged(const FrameVerdict &verdict, std::uint64_t dropped_sweeps)
{
    dropped_in_row_ += static_cast<unsigned>(dropped_sweeps - std::exchange(dropped_sweeps_, dropped_sweeps));
    if (verdict.label)
        return labelled(*verdict.label);
    reasons_.at(static_cast<std::size_t>(verdict.reason))++;
    unlabelled_in_row_++;
    if (unlabelled_in_row_ == sweeps_without_label * planes_)
        complain("The planes of the last " + std::to_string(unlabelled_in_row_) + " frames cannot be told");
    else if (dropped_in_row_ >= dropped_in_a_row)
        complain("Some planes of each of the last " + std::to_string(dropped_in_row_) +
                 " sweeps cannot be told");
}

Unlabelled LabelWatch::main_reason() const
{
    const auto most = std::max_element(reasons_.begin(), reasons_.end());
    return static_cast<Unlabelled>(most - reasons_.begin());
}

void LabelWatch::complain(const std::string &what)
{
    dropped_in_row_ = 0;
    const Unlabelled reason = main_reason();
    if (told_.insert(reason).second)
        complaint_ = what + ": " + what_to_check(reason) + ". The frames are dropped; stats counts them.";
}

} // namespace dff
