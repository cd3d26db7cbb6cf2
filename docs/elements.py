#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""elements.py [FOLDER]: writes a page for each element into FOLDER (elements beside this file), from what it tells GStreamer of
itself and from the doc comment of its source. Run it inside `meson devenv`, with every plug-in built. A test says when the pages
are out of date.
"""
import pathlib
import re
import sys

import gi

gi.require_version('Gst', '1.0')
from gi.repository import GObject, Gst  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[1]
TYPES = {'gboolean': 'true or false', 'gint': 'whole number', 'guint': 'whole number', 'gint64': 'whole number', 'guint64': 'whole number',
         'gfloat': 'number', 'gdouble': 'number', 'gchararray': 'text', 'GstStructure': 'structure', 'GstValueArray': 'array'}
LIMITS = {'guint': 2**32 - 1, 'gint': 2**31 - 1, 'guint64': 2**64 - 1, 'gint64': 2**63 - 1}
CHANGED = ((1 << 12, 'while playing'), (1 << 11, 'while paused'), (1 << 10, 'when ready'))  # GST_PARAM_MUTABLE_PLAYING and so on
MANY_FORMATS = 12


def factories():
    registry = Gst.Registry.get()
    found = [feature for plugin in registry.get_plugin_list() if plugin.get_source() == 'gst-plugins-dff'
             for feature in registry.get_feature_list_by_plugin(plugin.get_name()) if isinstance(feature, Gst.ElementFactory)]
    return sorted(found, key=lambda factory: factory.get_name())


def doc_comments():
    """What stands in the sources about each element, as Markdown."""
    found = {}
    for path in (ROOT / 'plugins').rglob('*.cpp'):
        for name, text in re.findall(r'^ \* SECTION:element-(\w+)\n(.*?)^ \*/', path.read_text(), re.MULTILINE | re.DOTALL):
            lines = [line[3:] for line in text.splitlines() if not line.startswith(' * @')]
            text = re.sub(r'\]\| *', '```\n', '\n'.join(lines).strip().replace('|[', '```sh'))
            found[name] = re.sub(r'^## ', '### ', text, flags=re.MULTILINE).strip()
    return found


def words_of(value, kind):
    """A value as it is set in gst-launch-1.0."""
    if value is None:
        return ''
    if GObject.type_is_a(kind, GObject.TYPE_ENUM):
        return value.value_nick
    if GObject.type_is_a(kind, GObject.TYPE_BOOLEAN):
        return 'true' if value else 'false'
    return f'{value:.6g}' if isinstance(value, float) else str(value)


def kind_of(spec):
    if GObject.type_is_a(spec.value_type, GObject.TYPE_ENUM):
        return ', '.join(f'`{value.value_nick}`' for value in spec.enum_class.__enum_values__.values())
    words = TYPES.get(spec.value_type.name, spec.value_type.name)
    least, most = getattr(spec, 'minimum', None), getattr(spec, 'maximum', None)
    limit = LIMITS.get(spec.value_type.name, 1e30)
    if least is None or most is None or (least <= -limit and most >= limit):
        return words
    least, most = (words_of(value, spec.value_type) for value in (least, most if most < limit else ''))
    return f'{words}, {least} to {most}' if most else f'{words}, from {least} on'


def changed_when(spec):
    if not spec.flags & GObject.ParamFlags.WRITABLE:
        return 'only read'
    return next((words for flag, words in CHANGED if int(spec.flags) & flag), 'before it starts')


def caps_of(template):
    text = re.sub(r'\((?:string|int|fraction)\)', '', template.get_caps().to_string()).replace('2147483647', 'max')
    return re.sub(r'\{[^{}]*\}', lambda match: 'any' if match.group().count(',') >= MANY_FORMATS else match.group(), text)


def cell(text):
    return text.replace('|', '\\|').replace('\n', ' ')


def table(heads, rows):
    lines = [heads, ['---'] * len(heads), *rows]
    return '\n'.join('| ' + ' | '.join(cell(text) for text in line) + ' |' for line in lines)


def pads(factory):
    rows = [(f'`{template.name_template}`', {Gst.PadDirection.SINK: 'sink', Gst.PadDirection.SRC: 'source'}[template.direction],
             template.presence.value_nick, f'`{caps_of(template)}`') for template in factory.get_static_pad_templates()]
    return table(('pad', 'direction', 'there', 'caps'), sorted(rows))


def properties(element):
    own = [spec for spec in element.list_properties() if GObject.type_is_a(spec.owner_type, element.__gtype__)]
    rows = [(f'`{spec.name}`', kind_of(spec), words_of(spec.default_value, spec.value_type), changed_when(spec), spec.blurb)
            for spec in sorted(own, key=lambda spec: spec.name)]
    return table(('property', 'values', 'default', 'may change', 'meaning'), rows)


def page(factory, comment):
    element = factory.create(None)
    parts = [f'# {factory.get_name()}', factory.get_metadata('description') + '.', comment]
    if factory.get_static_pad_templates():
        parts += ['## Pads', pads(factory)]
    parts += ['## Properties', properties(element)]
    return '\n\n'.join(part for part in parts if part) + '\n'


def main():
    folder = pathlib.Path(sys.argv[1]) if sys.argv[1:] else ROOT / 'docs/elements'
    folder.mkdir(exist_ok=True)
    Gst.init(None)
    comments, rows = doc_comments(), []
    for factory in factories():
        name = factory.get_name()
        (folder / f'{name}.md').write_text(page(factory, comments.get(name, '')))
        rows.append((f'[{name}]({name}.md)', factory.get_plugin_name(), factory.get_metadata('description')))
    index = ['# Elements', 'As `gst-inspect-1.0` shows them, with the comments of their sources. Written by `docs/elements.py`.',
             table(('element', 'plug-in', 'what it does'), rows)]
    (folder / 'README.md').write_text('\n\n'.join(index) + '\n')


if __name__ == '__main__':
    main()
