/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/app/app.h>
#include <map>
#include <string>

/* A pipeline of the test, whose appsinks gather what arrives. */
class Receiver {
public:
    explicit Receiver(const std::string &launch);
    ~Receiver();
    Receiver(const Receiver &) = delete;
    Receiver &operator=(const Receiver &) = delete;

    /* The next sample of the appsink with that name; null if the pipeline ends, fails, or 30 s pass. The
     * receiver keeps it until the next call for that appsink. */
    GstSample *next(const std::string &sink = "sink");

    /* Its buffer. */
    GstBuffer *next_buffer(const std::string &sink = "sink");

    /* What went wrong, if anything did; waits up to 30 s for it. */
    std::string error();

    GstElement *pipeline() { return pipeline_; }

private:
    GstElement *pipeline_;
    std::map<std::string, GstSample *> last_;
};
