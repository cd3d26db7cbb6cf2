#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Writes OpenCL sources as C++ string literals, their #include lines replaced by the files they name:
embed_kernels.py OUTPUT KERNEL.cl..."""
import pathlib
import re
import sys

output, *kernels = map(pathlib.Path, sys.argv[1:])


def source(kernel):
    return re.sub(r'^#include "(.*)"$', lambda line: source(kernel.parent / line[1]), kernel.read_text(), flags=re.M)


entries = "".join(f'    {{"{k.stem}", R"opencl({source(k)})opencl"}},\n' for k in kernels)
output.write_text(f"""#include "engine/opencl/kernel_sources.h"

namespace dff {{

const std::map<std::string_view, std::string_view> &kernel_sources()
{{
    static const std::map<std::string_view, std::string_view> sources = {{
{entries}    }};
    return sources;
}}

}} // namespace dff
""")
