/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/gst.h>

/* What a source pad sends before its first buffer; each is sent unless the pad has sent it before. */
void begin_stream(GstElement *element, GstPad *pad, const gchar *name, guint group);
void begin_segment(GstPad *pad);

/* False if the peer refuses the caps. */
bool change_caps(GstPad *pad, GstCaps *caps);

/* Whether the peer still takes the caps that were sent. A sticky event counts as sent even where it is
 * refused; the buffer behind it ends the stream then. */
bool caps_are_taken(GstPad *pad);

/* The group that begin_stream() was given. */
guint group_of(GstPad *pad);
