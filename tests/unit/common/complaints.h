/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <glib.h>
#include <gtest/gtest.h>

/* While it lives, what GStreamer complains of to GLib is a failure of the test. */
class Complaints {
public:
    Complaints()
        : handler_(g_log_set_handler(
              "GStreamer", static_cast<GLogLevelFlags>(G_LOG_LEVEL_CRITICAL | G_LOG_LEVEL_WARNING),
              [](const gchar *, GLogLevelFlags, const gchar *text, gpointer) { ADD_FAILURE() << text; },
              nullptr))
    {
    }
    Complaints(const Complaints &) = delete;
    Complaints &operator=(const Complaints &) = delete;
    ~Complaints() { g_log_remove_handler("GStreamer", handler_); }

private:
    guint handler_;
};
