/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <functional>
#include <gst/gst.h>
#include <string>

namespace dff {

/* The name of an element that is put behind each description. */
inline constexpr const char *source_end = "source-end";

/* The bin of a description in the notation of gst-launch-1.0. Its ghost pad "src" is the last source pad that
 * the description leaves free; pads that come later, as a demuxer's do, find the links that were written for
 * them. A floating reference, or nullptr and why in `error`. */
GstElement *make_camera_source(const std::string &description, std::string &error);

/* Brings what a source gives to where it belongs: frames to the tee `planes`, from which the mux takes them;
 * stacks past the mux to the tee `stacks`. The caps that a pad could have tell little before data flows
 * (those of a file's reader are ANY), so that it is decided at each CAPS event, in the thread of the source;
 * until then the source is answered what either way would take. Owns nothing: the bin around it does. */
class SourceRoute {
public:
    /* `on_fault` gets the reason why what comes cannot be used, in the thread of the source. */
    SourceRoute(GstElement *planes, GstElement *mux, GstElement *stacks,
                std::function<void(const std::string &reason)> on_fault);
    SourceRoute(const SourceRoute &) = delete;
    SourceRoute &operator=(const SourceRoute &) = delete;

    /* Links a source's pad, as if it gave frames. Returns why it will never do, or nothing. */
    std::string connect(GstPad *source);

private:
    static GstPadProbeReturn probe(GstPad *source, GstPadProbeInfo *info, gpointer self);
    GstPadProbeReturn take_caps(GstPad *source, GstCaps *caps);
    GstPadProbeReturn answer(GstQuery *query) const;
    GstCaps *possible_caps(GstCaps *filter) const;
    std::string fault_of(GstCaps *caps) const;
    void lead(GstPad *source, bool stacks);

    GstElement *const planes_, *const mux_, *const stacks_;
    const std::function<void(const std::string &reason)> on_fault_;
};

} // namespace dff
