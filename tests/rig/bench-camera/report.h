/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

namespace dff {

/* What the bench camera did, for tests to hold against what its client says. Every trigger is one of unheard,
 * missed, ignored and exposed; every exposure is one of sent, lost and unsent. */
class Report {
public:
    using Count = std::atomic<uint64_t>;

    Count triggers = 0;     /* on the trigger line */
    Count syncs = 0;        /* on the sync line */
    Count syncs_lost = 0;   /* made, and not sent */
    Count software = 0;     /* triggers by command */
    Count unheard = 0;      /* came while the camera did not listen to them */
    Count missed = 0;       /* came while the sensor was still busy */
    Count ignored = 0;      /* faults: no frame, no frame id */
    Count exposed = 0;      /* each has a frame id */
    Count lost = 0;         /* faults: a frame id, and no frame */
    Count sent = 0;         /* first sendings, in or out of order */
    Count duplicates = 0;   /* second sendings */
    Count late = 0;         /* sent after the frame that follows */
    Count unsent = 0;       /* still in the camera when the client stopped the acquisition */
    Count acquisitions = 0; /* started */
    Count focus_moves = 0;  /* of the lens that a register moves */

    void add_lost_id(uint16_t frame_id);

    std::string json() const;

private:
    mutable std::mutex mutex_;
    std::vector<uint16_t> lost_ids_;
};

} // namespace dff
