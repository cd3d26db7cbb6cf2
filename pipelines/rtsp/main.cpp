/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/* dff-rtsp-server: depth and all-in-focus video by RTSP. `dff-rtsp-server --help` says how. */
#include "server.h"
#include "warm_up.h"

#include <cstdio>
#include <cstdlib>
#include <glib-unix.h>

namespace {

struct LoopUnref {
    void operator()(GMainLoop *loop) const { g_main_loop_unref(loop); }
};

/* Kernels compile in seconds; in minutes where others have the processors. */
constexpr std::chrono::seconds warm_up_patience{120};

gboolean quit(gpointer loop)
{
    g_main_loop_quit(static_cast<GMainLoop *>(loop));
    return G_SOURCE_CONTINUE;
}

void serve(const dff::ServerOptions &options)
{
    const dff::Server server(options, std::make_shared<dff::Capture>(options.launch));
    const dff::ObjectPointer<GstElementFactory> extension(gst_element_factory_find("rtphdrextdff"));
    if (!extension)
        g_warning("Plane and depth facts of each frame are not sent: the plug-in dffrtp is missing");
    g_message("The source is tried");
    dff::warm_up(options.launch, warm_up_patience);

    /* Before it says that it serves: whoever reads that may end it at once. */
    const std::unique_ptr<GMainLoop, LoopUnref> loop(g_main_loop_new(nullptr, FALSE));
    g_unix_signal_add(SIGINT, quit, loop.get());
    g_unix_signal_add(SIGTERM, quit, loop.get());
    for (const std::string &url : server.urls())
        std::printf("%s\n", url.c_str());
    std::fflush(stdout);
    g_main_loop_run(loop.get());
}

} // namespace

int main(int argc, char **argv)
{
    try {
        serve(dff::parse_options(argc, argv));
    } catch (const std::exception &error) {
        std::fprintf(stderr, "dff-rtsp-server: %s\n", error.what());
        return EXIT_FAILURE;
    }
    return EXIT_SUCCESS;
}
