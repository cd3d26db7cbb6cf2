/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "config.h"
#include "depthcolorize.h"
#ifdef HAVE_OPENEXR
#include "depthexrenc.h"
#endif
#include "depthplyenc.h"
#include "depthuncolorize.h"
#include "dffmetadepay.h"
#include "dffmetapay.h"

static gboolean plugin_init(GstPlugin *plugin)
{
    const bool colours =
        GST_ELEMENT_REGISTER(depthcolorize, plugin) && GST_ELEMENT_REGISTER(depthuncolorize, plugin);
    const bool metas = GST_ELEMENT_REGISTER(dffmetapay, plugin) && GST_ELEMENT_REGISTER(dffmetadepay, plugin);
    gboolean files = GST_ELEMENT_REGISTER(depthplyenc, plugin);
#ifdef HAVE_OPENEXR
    files = files && GST_ELEMENT_REGISTER(depthexrenc, plugin);
#endif
    return colours && metas && files;
}

GST_PLUGIN_DEFINE(GST_VERSION_MAJOR, GST_VERSION_MINOR, depthio, "Depth as colours, pictures and points",
                  plugin_init, VERSION, GST_LICENSE, PACKAGE, GST_PACKAGE_ORIGIN)
