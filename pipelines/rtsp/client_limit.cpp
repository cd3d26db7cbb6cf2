/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "client_limit.h"

#include "gst_pointer.h"
#include "log.h"

#include <vector>

namespace dff {

namespace {

/* Connections that may each have a thread before they have set a stream up; more share threads. */
constexpr int threads_beyond_clients = 16;

/* The sessions that a connection began. GStreamer 1.22 would count them for another minute after its end,
 * though they show nothing any more. Used by the thread of the connection. */
using Sessions = std::vector<ObjectPointer<GstRTSPSession>>;

void remember(GstRTSPClient *, GstRTSPSession *session, gpointer sessions)
{
    static_cast<Sessions *>(sessions)->push_back(share(session));
}

const char *ip_of(GstRTSPClient *client)
{
    const GstRTSPConnection *connection = gst_rtsp_client_get_connection(client);
    return connection ? gst_rtsp_connection_get_ip(connection) : "an unknown address";
}

void forget(GstRTSPClient *client, gpointer data)
{
    GST_INFO("The client at %s is gone", ip_of(client));
    const ObjectPointer<GstRTSPSessionPool> pool(gst_rtsp_client_get_session_pool(client));
    auto &sessions = *static_cast<Sessions *>(data);
    for (const auto &session : sessions)
        gst_rtsp_session_pool_remove(pool.get(), session.get());
    sessions.clear();
}

/* The session pool refuses the SETUP of one client too many; this tells it before the capture is started for
 * it. */
GstRTSPStatusCode check_room(GstRTSPClient *client, GstRTSPContext *context, gpointer)
{
    const ObjectPointer<GstRTSPSessionPool> pool(gst_rtsp_client_get_session_pool(client));
    const bool has_room =
        gst_rtsp_session_pool_get_n_sessions(pool.get()) < gst_rtsp_session_pool_get_max_sessions(pool.get());
    if (has_room || context->session)
        return GST_RTSP_STS_OK;
    g_message("The client at %s is one too many: see --max-clients", ip_of(client));
    return GST_RTSP_STS_SERVICE_UNAVAILABLE;
}

void welcome(GstRTSPServer *, GstRTSPClient *client, gpointer)
{
    GST_INFO("A client comes from %s", ip_of(client));
    const auto destroy = [](gpointer sessions, GClosure *) { delete static_cast<Sessions *>(sessions); };
    auto *sessions = new Sessions;
    g_signal_connect(client, "pre-describe-request", G_CALLBACK(check_room), nullptr);
    g_signal_connect(client, "new-session", G_CALLBACK(remember), sessions);
    g_signal_connect_data(client, "closed", G_CALLBACK(forget), sessions, destroy, GConnectFlags{});
}

} // namespace

void limit_clients(GstRTSPServer *server, unsigned max_clients)
{
    /* A thread a client: a slow one, or one that waits for the source to start, holds up nobody else. */
    const ObjectPointer<GstRTSPThreadPool> threads(gst_rtsp_server_get_thread_pool(server));
    gst_rtsp_thread_pool_set_max_threads(threads.get(),
                                         static_cast<int>(max_clients) + threads_beyond_clients);

    const ObjectPointer<GstRTSPSessionPool> pool(gst_rtsp_server_get_session_pool(server));
    gst_rtsp_session_pool_set_max_sessions(pool.get(), max_clients);
    g_signal_connect(server, "client-connected", G_CALLBACK(welcome), nullptr);
}

} // namespace dff
