/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "server.h"

#include "accounts.h"
#include "client_limit.h"
#include "host_address.h"
#include "mount_media.h"

#include <stdexcept>

namespace dff {

namespace {

constexpr guint seconds_between_cleanups = 2;
constexpr gint64 microseconds_to_close = 3 * G_USEC_PER_SEC;

bool is_possible(const Mount &mount, const std::set<std::string> &outputs)
{
    if (!std::includes(outputs.begin(), outputs.end(), mount.outputs.begin(), mount.outputs.end()))
        return false;
    for (const std::string &element : mount.elements) {
        const ObjectPointer<GstElementFactory> factory(gst_element_factory_find(element.c_str()));
        if (!factory) {
            g_message("%s is left out: there is no element %s", mount.path.c_str(), element.c_str());
            return false;
        }
    }
    return true;
}

} // namespace

Server::Server(const ServerOptions &options, std::shared_ptr<Capture> capture)
    : capture_(std::move(capture)), server_(gst_rtsp_server_new()),
      scheme_(options.certificate.empty() ? "rtsp" : "rtsps")
{
    const ObjectPointer<GstRTSPAuth> auth = make_auth(options);
    gst_rtsp_server_set_auth(server_.get(), auth.get());
    gst_rtsp_server_set_address(server_.get(), options.address.c_str());
    gst_rtsp_server_set_service(server_.get(), std::to_string(options.port).c_str());
    add_mounts(auth != nullptr, !options.certificate.empty());
    limit_clients(server_.get(), static_cast<unsigned>(options.max_clients));
    clean_up_regularly();

    g_autoptr(GError) error = nullptr;
    GSource *source = gst_rtsp_server_create_source(server_.get(), nullptr, &error);
    if (!source)
        throw std::runtime_error("Cannot listen on " + options.address + " port " +
                                 std::to_string(options.port) + ": " + error->message);
    accept_source_ = g_source_attach(source, nullptr);
    g_source_unref(source);
}

Server::~Server()
{
    g_source_remove(cleanup_source_);
    if (accept_source_)
        g_source_remove(accept_source_);
    const auto close = [](GstRTSPServer *, GstRTSPClient *, gpointer) { return GST_RTSP_FILTER_REMOVE; };
    gst_rtsp_server_client_filter(server_.get(), close, nullptr);
    const gint64 deadline = g_get_monotonic_time() + microseconds_to_close;
    while (capture_->is_wanted() && g_get_monotonic_time() < deadline)
        if (!g_main_context_iteration(nullptr, FALSE))
            g_usleep(1000);
}

void Server::add_mounts(bool with_auth, bool tcp_only)
{
    const ObjectPointer<GstRTSPMountPoints> mount_points(gst_rtsp_server_get_mount_points(server_.get()));
    for (const Mount &mount : all_mounts()) {
        if (!is_possible(mount, capture_->outputs()))
            continue;
        ObjectPointer<GstRTSPMediaFactory> factory = make_factory(mount, capture_, tcp_only);
        if (with_auth)
            restrict_to_viewers(factory.get());
        gst_rtsp_mount_points_add_factory(mount_points.get(), mount.path.c_str(), factory.release());
        paths_.push_back(mount.path);
    }
}

void Server::clean_up_regularly()
{
    const auto clean_up = +[](gpointer server) -> gboolean {
        const ObjectPointer<GstRTSPSessionPool> pool(
            gst_rtsp_server_get_session_pool(GST_RTSP_SERVER(server)));
        gst_rtsp_session_pool_cleanup(pool.get());
        return G_SOURCE_CONTINUE;
    };
    cleanup_source_ = g_timeout_add_seconds(seconds_between_cleanups, clean_up, server_.get());
}

std::vector<std::string> Server::urls() const
{
    g_autofree char *address = gst_rtsp_server_get_address(server_.get());
    const std::string host = host_in_url(address);
    std::vector<std::string> urls;
    for (const std::string &path : paths_)
        urls.push_back(scheme_ + "://" + host + ":" +
                       std::to_string(gst_rtsp_server_get_bound_port(server_.get())) + path);
    return urls;
}

} // namespace dff
