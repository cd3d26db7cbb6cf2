/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "accounts.h"

#include <stdexcept>

namespace dff {

namespace {

struct TokenUnref {
    void operator()(GstRTSPToken *token) const { gst_rtsp_token_unref(token); }
};

void add_account(GstRTSPAuth *auth, const std::string &user, const std::string &password, GstRTSPToken *token)
{
    g_autofree char *basic = gst_rtsp_auth_make_basic(user.c_str(), password.c_str());
    gst_rtsp_auth_add_basic(auth, basic, token);
    gst_rtsp_auth_add_digest(auth, user.c_str(), password.c_str(), token);
}

} // namespace

ObjectPointer<GstRTSPAuth> make_auth(const ServerOptions &options)
{
    if (options.accounts.empty() && options.certificate.empty())
        return nullptr;
    ObjectPointer<GstRTSPAuth> auth(gst_rtsp_auth_new());
    gst_rtsp_auth_set_realm(auth.get(), "dff-rtsp-server");
    gst_rtsp_auth_set_supported_methods(
        auth.get(), static_cast<GstRTSPAuthMethod>(GST_RTSP_AUTH_BASIC | GST_RTSP_AUTH_DIGEST));
    const std::unique_ptr<GstRTSPToken, TokenUnref> viewer(
        gst_rtsp_token_new(GST_RTSP_TOKEN_MEDIA_FACTORY_ROLE, G_TYPE_STRING, viewer_role, nullptr));
    for (const auto &[user, password] : options.accounts)
        add_account(auth.get(), user, password, viewer.get());
    if (options.accounts.empty())
        gst_rtsp_auth_set_default_token(auth.get(), viewer.get());

    if (!options.certificate.empty()) {
        g_autoptr(GError) error = nullptr;
        const ObjectPointer<GTlsCertificate> certificate(
            g_tls_certificate_new_from_file(options.certificate.c_str(), &error));
        if (!certificate)
            throw std::invalid_argument("Cannot use the certificate " + options.certificate + ": " +
                                        error->message);
        gst_rtsp_auth_set_tls_certificate(auth.get(), certificate.get());
    }
    return auth;
}

void restrict_to_viewers(GstRTSPMediaFactory *factory)
{
    gst_rtsp_media_factory_add_role(factory, viewer_role, GST_RTSP_PERM_MEDIA_FACTORY_ACCESS, G_TYPE_BOOLEAN,
                                    TRUE, GST_RTSP_PERM_MEDIA_FACTORY_CONSTRUCT, G_TYPE_BOOLEAN, TRUE,
                                    nullptr);
}

} // namespace dff
