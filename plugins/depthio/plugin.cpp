/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "config.h"
#include "depthcolorize.h"
#include "depthuncolorize.h"

static gboolean plugin_init(GstPlugin *plugin)
{
    return GST_ELEMENT_REGISTER(depthcolorize, plugin) && GST_ELEMENT_REGISTER(depthuncolorize, plugin);
}

GST_PLUGIN_DEFINE(GST_VERSION_MAJOR, GST_VERSION_MINOR, depthio, "Depth as colours, pictures and points",
                  plugin_init, VERSION, GST_LICENSE, PACKAGE, GST_PACKAGE_ORIGIN)
