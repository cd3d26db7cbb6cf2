/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "accounts.h"

#include <stdexcept>

namespace dff {

namespace {

struct TokenUnref {
    void operator()(GstRTSPToken *token) const { gst_rtsp_token_unref(token); }
};

/* Basic authentication sends the password as it is, so that it is for encrypted connections, or by request.
 */
void add_accounts(GstRTSPAuth *auth, const ServerOptions &options, GstRTSPToken *token)
{
    const bool basic = options.basic || !options.certificate.empty();
    gst_rtsp_auth_set_supported_methods(
        auth, basic ? static_cast<GstRTSPAuthMethod>(GST_RTSP_AUTH_BASIC | GST_RTSP_AUTH_DIGEST)
                    : GST_RTSP_AUTH_DIGEST);
    for (const auto &[user, password] : options.accounts) {
        gst_rtsp_auth_add_digest(auth, user.c_str(), password.c_str(), token);
        if (!basic)
            continue;
        g_autofree char *credentials = gst_rtsp_auth_make_basic(user.c_str(), password.c_str());
        gst_rtsp_auth_add_basic(auth, credentials, token);
    }
}

ObjectPointer<GTlsCertificate> read_certificate(const std::string &path)
{
    g_autoptr(GError) error = nullptr;
    ObjectPointer<GTlsCertificate> certificate(g_tls_certificate_new_from_file(path.c_str(), &error));
    if (!certificate)
        throw std::invalid_argument("Cannot use the certificate " + path + ": " + error->message);
    g_autoptr(GByteArray) key = nullptr;
    g_object_get(certificate.get(), "private-key", &key, nullptr);
    if (!key)
        throw std::invalid_argument("There is no private key in " + path +
                                    ": put both into one file, as by `cat key.pem cert.pem > server.pem`");
    return certificate;
}

} // namespace

ObjectPointer<GstRTSPAuth> make_auth(const ServerOptions &options)
{
    if (options.accounts.empty() && options.certificate.empty())
        return nullptr;
    ObjectPointer<GstRTSPAuth> auth(gst_rtsp_auth_new());
    gst_rtsp_auth_set_realm(auth.get(), "dff-rtsp-server");
    const std::unique_ptr<GstRTSPToken, TokenUnref> viewer(
        gst_rtsp_token_new(GST_RTSP_TOKEN_MEDIA_FACTORY_ROLE, G_TYPE_STRING, viewer_role, nullptr));
    add_accounts(auth.get(), options, viewer.get());
    if (options.accounts.empty())
        gst_rtsp_auth_set_default_token(auth.get(), viewer.get());

    if (!options.certificate.empty())
        gst_rtsp_auth_set_tls_certificate(auth.get(), read_certificate(options.certificate).get());
    return auth;
}

void restrict_to_viewers(GstRTSPMediaFactory *factory)
{
    gst_rtsp_media_factory_add_role(factory, viewer_role, GST_RTSP_PERM_MEDIA_FACTORY_ACCESS, G_TYPE_BOOLEAN,
                                    TRUE, GST_RTSP_PERM_MEDIA_FACTORY_CONSTRUCT, G_TYPE_BOOLEAN, TRUE,
                                    nullptr);
}

} // namespace dff
