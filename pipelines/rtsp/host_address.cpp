/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "host_address.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <memory>
#include <net/if.h>

namespace dff {

namespace {

struct FreeAddresses {
    void operator()(ifaddrs *addresses) const { freeifaddrs(addresses); }
};

bool is_every_address(const std::string &address)
{
    return address.empty() || address == "0.0.0.0" || address == "::";
}

/* IPv4, which is short enough to type; a server on :: takes it too. */
std::string first_address_of_this_machine()
{
    ifaddrs *all = nullptr;
    if (getifaddrs(&all) != 0)
        return "localhost";
    const std::unique_ptr<ifaddrs, FreeAddresses> addresses(all);
    for (const ifaddrs *entry = all; entry; entry = entry->ifa_next) {
        if (!entry->ifa_addr || entry->ifa_addr->sa_family != AF_INET || !(entry->ifa_flags & IFF_UP) ||
            (entry->ifa_flags & IFF_LOOPBACK))
            continue;
        char text[INET_ADDRSTRLEN] = {};
        const auto *internet = reinterpret_cast<const sockaddr_in *>(entry->ifa_addr);
        if (inet_ntop(AF_INET, &internet->sin_addr, text, sizeof text))
            return text;
    }
    return "localhost";
}

} // namespace

std::string host_in_url(const std::string &address)
{
    if (is_every_address(address))
        return first_address_of_this_machine();
    return address.find(':') == std::string::npos ? address : "[" + address + "]";
}

} // namespace dff
