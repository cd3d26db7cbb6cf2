/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "story.h"

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <glib.h>
#include <mutex>
#include <thread>

namespace dff::walk {

namespace {

std::chrono::seconds patience()
{
    const char *value = std::getenv("DFF_WALK_PATIENCE");
    return std::chrono::seconds(value ? std::stol(value) : 60);
}

/* Guards all of this. Nothing else is locked under it. */
std::mutex mutex;
std::vector<std::string> steps;
std::vector<std::string> complaint_lines;
std::chrono::steady_clock::time_point deadline;
bool over = true;

std::string joined()
{
    std::string text;
    for (const std::string &step : steps)
        text += "    " + step + "\n";
    return text;
}

std::string domain(const GLogField *fields, gsize count)
{
    for (gsize i = 0; i < count; i++)
        if (g_str_equal(fields[i].key, "GLIB_DOMAIN"))
            return static_cast<const char *>(fields[i].value);
    return "";
}

GLogWriterOutput write_log(GLogLevelFlags level, const GLogField *fields, gsize count, gpointer)
{
    /* GStreamer's own warnings are of events in the wrong order. */
    const bool warned = (level & G_LOG_LEVEL_WARNING) != 0 && domain(fields, count) == "GStreamer";
    if (warned || (level & (G_LOG_LEVEL_CRITICAL | G_LOG_LEVEL_ERROR)) != 0) {
        g_autofree gchar *line = g_log_writer_format_fields(level, fields, count, FALSE);
        const std::lock_guard lock(mutex);
        complaint_lines.emplace_back(line);
    }
    return g_log_writer_default(level, fields, count, nullptr);
}

void watch()
{
    while (true) {
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        const std::lock_guard lock(mutex);
        if (over || std::chrono::steady_clock::now() < deadline)
            continue;
        std::fprintf(stderr, "The last step does not end:\n%s", joined().c_str());
        std::abort();
    }
}

void start_watching()
{
    static const bool once = [] {
        g_log_set_writer_func(write_log, nullptr, nullptr);
        std::thread(watch).detach();
        return true;
    }();
    (void)once;
}

} // namespace

Story::Story(std::string title)
{
    start_watching();
    const std::lock_guard lock(mutex);
    steps = {std::move(title)};
    complaint_lines.clear();
    deadline = std::chrono::steady_clock::now() + patience();
    over = false;
}

Story::~Story()
{
    const std::lock_guard lock(mutex);
    over = true;
}

void Story::step(const std::string &text)
{
    const std::lock_guard lock(mutex);
    steps.push_back(text);
    deadline = std::chrono::steady_clock::now() + patience();
    if (std::getenv("DFF_WALK_ALOUD"))
        std::fprintf(stderr, "    %s\n", text.c_str());
}

std::string Story::text() const
{
    const std::lock_guard lock(mutex);
    return joined();
}

std::vector<std::string> Story::complaints()
{
    const std::lock_guard lock(mutex);
    return complaint_lines;
}

} // namespace dff::walk
