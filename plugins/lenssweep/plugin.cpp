/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#include "lenssweeptestsrc.h"

static gboolean plugin_init(GstPlugin *plugin)
{
    return GST_ELEMENT_REGISTER(lenssweeptestsrc, plugin);
}

GST_PLUGIN_DEFINE(GST_VERSION_MAJOR, GST_VERSION_MINOR, lenssweep,
                  "Sources of planes taken with a swept focus", plugin_init, VERSION, GST_LICENSE, PACKAGE,
                  GST_PACKAGE_ORIGIN)
