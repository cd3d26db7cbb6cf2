/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "server_options.h"

#include <gst/gst.h>
#include <stdexcept>

namespace dff {

namespace {

const char *const simulated_rig =
    "lenssweeptestsrc is-live=true rate=10 motion=2 ! tee name=planes"
    "  planes. ! queue ! focalstackmux ! tee name=stacks"
    "  stacks. ! queue ! dffdepth name=dffdepth  dffdepth.src ! tee name=depth"
    "  dffdepth.uncertainty ! queue ! identity name=uncertainty"
    "  stacks. ! queue ! aifcompose.stack  depth. ! queue ! aifcompose.depth  aifcompose name=aifcompose ! "
    "identity name=aif";

const char *const account_group = "accounts";

const char *const description =
    "Streams depth and all-in-focus video by RTSP. One capture is shared by all clients; it starts with the\n"
    "first and stops after the last.\n"
    "\n"
    "  /color   all-in-focus video, H.264                    /stream  /color and /depth, in step\n"
    "  /depth   depth, lossless, 16-bit JPEG 2000            /rgbd    colour and depth side by side, H.264\n"
    "  /hue     depth in hues, H.264                         /planes  the planes themselves, lossless\n"
    "  /uncertainty   one standard deviation of each pixel of /depth, lossless, as /depth\n"
    "\n"
    "The source pipeline gives depth where an element named depth has a free source pad or is a tee, and "
    "the\n"
    "same for uncertainty, aif and planes; or where any element has a free source pad of that name. A mount "
    "needs the\n"
    "outputs it shows.";

/* What GLib fills in; freed with it. */
struct RawOptions {
    char *launch = nullptr;
    char *address = nullptr;
    int port = ServerOptions().port;
    int max_clients = ServerOptions().max_clients;
    char **accounts = nullptr;
    char *accounts_file = nullptr;
    gboolean basic = FALSE;
    char *certificate = nullptr;

    RawOptions() = default;
    RawOptions(const RawOptions &) = delete;
    RawOptions &operator=(const RawOptions &) = delete;
    ~RawOptions()
    {
        g_strfreev(accounts);
        for (char *text : {launch, address, accounts_file, certificate})
            g_free(text);
    }
};

void parse(RawOptions &raw, int argc, char **argv)
{
    const GOptionEntry entries[] = {
        {"launch", 'l', 0, G_OPTION_ARG_STRING, &raw.launch, "Source pipeline; default: the simulated rig",
         "PIPELINE"},
        {"address", 'a', 0, G_OPTION_ARG_STRING, &raw.address, "Address to listen on; default: all",
         "ADDRESS"},
        {"port", 'p', 0, G_OPTION_ARG_INT, &raw.port, "Port to listen on, 0 to 65535; 0: any; default: 8554",
         "PORT"},
        {"max-clients", 'm', 0, G_OPTION_ARG_INT, &raw.max_clients,
         "Clients at a time; 1 to 10000; one more is answered 503 Service Unavailable; default: 32", "N"},
        {"account", 'u', 0, G_OPTION_ARG_STRING_ARRAY, &raw.accounts,
         "Let in this user; may be given again. Others on this machine can read it: prefer --accounts",
         "USER:PASSWORD"},
        {"accounts", 'f', 0, G_OPTION_ARG_FILENAME, &raw.accounts_file,
         "Let in the users of this file: a line [accounts], then USER=PASSWORD lines", "FILE"},
        {"basic", 'b', 0, G_OPTION_ARG_NONE, &raw.basic,
         "Take passwords in the clear too, for clients without digest authentication", nullptr},
        {"certificate", 'c', 0, G_OPTION_ARG_FILENAME, &raw.certificate,
         "Serve rtsps:// with the certificate and key of this PEM file, media over TCP only", "FILE"},
        {nullptr, 0, 0, G_OPTION_ARG_NONE, nullptr, nullptr, nullptr},
    };
    g_autoptr(GOptionContext) context = g_option_context_new(nullptr);
    g_option_context_set_summary(context, description);
    g_option_context_add_main_entries(context, entries, nullptr);
    g_option_context_add_group(context, gst_init_get_option_group());
    g_autoptr(GError) error = nullptr;
    if (!g_option_context_parse(context, &argc, &argv, &error))
        throw std::invalid_argument(error->message);
    if (argc > 1)
        throw std::invalid_argument(std::string("Unknown argument ") + argv[1] + "; see --help");
}

void add_account(ServerOptions &options, const std::string &user, const std::string &password)
{
    if (user.empty() || password.empty() || user.find(':') != std::string::npos)
        throw std::invalid_argument("An account needs a user, without a colon, and a password");
    options.accounts[user] = password;
}

void read_accounts(ServerOptions &options, const char *path)
{
    g_autoptr(GKeyFile) file = g_key_file_new();
    g_autoptr(GError) error = nullptr;
    g_auto(GStrv) users = nullptr;
    if (g_key_file_load_from_file(file, path, G_KEY_FILE_NONE, &error))
        users = g_key_file_get_keys(file, account_group, nullptr, &error);
    if (!users)
        throw std::invalid_argument(std::string("Cannot read the accounts of ") + path + ": " +
                                    error->message);
    for (char **user = users; *user; user++) {
        g_autofree char *password = g_key_file_get_value(file, account_group, *user, nullptr);
        add_account(options, *user, password);
    }
    if (options.accounts.empty())
        throw std::invalid_argument(std::string("There are no accounts in ") + path);
}

void check(const ServerOptions &options)
{
    if (options.port < 0 || options.port > 65535)
        throw std::invalid_argument("The port must lie between 0 and 65535");
    if (options.max_clients < 1 || options.max_clients > most_clients)
        throw std::invalid_argument("The number of clients must lie between 1 and " +
                                    std::to_string(most_clients));
}

} // namespace

ServerOptions parse_options(int argc, char **argv)
{
    RawOptions raw;
    parse(raw, argc, argv);
    ServerOptions options;
    options.launch = raw.launch ? raw.launch : simulated_rig;
    if (raw.address)
        options.address = raw.address;
    options.port = raw.port;
    options.max_clients = raw.max_clients;
    if (raw.accounts_file)
        read_accounts(options, raw.accounts_file);
    for (char **account = raw.accounts; account && *account; account++) {
        const std::string text = *account;
        const size_t colon = text.find(':');
        add_account(options, text.substr(0, colon), colon == std::string::npos ? "" : text.substr(colon + 1));
    }
    options.basic = raw.basic;
    if (raw.certificate)
        options.certificate = raw.certificate;
    check(options);
    return options;
}

} // namespace dff
