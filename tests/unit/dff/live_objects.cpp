/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "live_objects.h"

#include <algorithm>
#include <fstream>
#include <gst/gst.h>
#include <unistd.h>

namespace dff {

std::map<std::string, unsigned> live_objects()
{
    std::map<std::string, unsigned> count;
    GList *tracers = gst_tracing_get_active_tracers();
    for (GList *item = tracers; item; item = item->next) {
        if (!g_str_equal(G_OBJECT_TYPE_NAME(item->data), "GstLeaksTracer"))
            continue;
        GstStructure *live = nullptr;
        g_signal_emit_by_name(item->data, "get-live-objects", &live);
        const GValue *list = gst_structure_get_value(live, "live-objects-list");
        for (guint i = 0; i < gst_value_list_get_size(list); i++) {
            const GstStructure *object = gst_value_get_structure(gst_value_list_get_value(list, i));
            const GValue *value = gst_structure_get_value(object, "object");
            count[G_VALUE_TYPE_NAME(value)]++;
        }
        /* Not freed: the tracer of 1.22 lists its objects without a reference, and freeing would take one
         * away. */
    }
    g_list_free_full(tracers, gst_object_unref);
    return count;
}

std::map<std::string, unsigned> left_behind(const std::map<std::string, unsigned> &before)
{
    std::map<std::string, unsigned> more;
    for (int attempt = 0; attempt < 40; attempt++) {
        more = live_objects();
        for (const auto &[type, count] : before)
            more[type] -= std::min(count, more[type]);
        std::erase_if(more, [](const auto &entry) { return entry.second == 0; });
        if (more.empty())
            break;
        g_usleep(G_USEC_PER_SEC / 8);
    }
    return more;
}

size_t resident_kib()
{
    size_t pages = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> pages >> resident;
    return resident * static_cast<size_t>(sysconf(_SC_PAGESIZE)) / 1024;
}

bool is_sanitized()
{
#ifdef __SANITIZE_ADDRESS__
    return true;
#else
    return false;
#endif
}

} // namespace dff
