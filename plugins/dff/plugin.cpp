/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "aifcompose.h"
#include "common/stack_noise.h"
#include "config.h"
#include "dffcamerabin.h"
#include "dffdepth.h"

static gboolean plugin_init(GstPlugin *plugin)
{
    dff::stack_noise_meta_name(); /* plug-ins are loaded one after the other: nobody else registers it now */
    return GST_ELEMENT_REGISTER(dffdepth, plugin) && GST_ELEMENT_REGISTER(aifcompose, plugin) &&
           GST_ELEMENT_REGISTER(dffcamerabin, plugin);
}

GST_PLUGIN_DEFINE(GST_VERSION_MAJOR, GST_VERSION_MINOR, dffdepth,
                  "Depth and all-in-focus pictures from focal stacks", plugin_init, VERSION, GST_LICENSE,
                  PACKAGE, GST_PACKAGE_ORIGIN)
