/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "report.h"

#include <sstream>
#include <utility>

namespace dff {

void Report::add_lost_id(uint16_t frame_id)
{
    const std::scoped_lock lock(mutex_);
    lost_ids_.push_back(frame_id);
}

std::string Report::json() const
{
    const std::pair<const char *, const Count &> counts[] = {
        {"triggers", triggers},
        {"syncs", syncs},
        {"syncs_lost", syncs_lost},
        {"software", software},
        {"unheard", unheard},
        {"missed", missed},
        {"ignored", ignored},
        {"exposed", exposed},
        {"lost", lost},
        {"sent", sent},
        {"late", late},
        {"duplicates", duplicates},
        {"unsent", unsent},
        {"acquisitions", acquisitions},
        {"focus_moves", focus_moves},
    };
    std::ostringstream text;
    text << '{';
    for (const auto &[name, count] : counts)
        text << '"' << name << "\": " << count << ", ";
    text << "\"lost_ids\": [";
    const std::scoped_lock lock(mutex_);
    for (size_t i = 0; i < lost_ids_.size(); i++)
        text << (i == 0 ? "" : ", ") << lost_ids_[i];
    text << "]}";
    return text.str();
}

} // namespace dff
