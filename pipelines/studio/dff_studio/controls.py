# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""The elements' own properties, as the page shows and sets them; and what they count."""
import math

from gi.repository import GObject, Gst

from dff_studio import Unusable
from dff_studio.frames import without_nan
from dff_studio.source import items

PLUGINS = {'lenssweep', 'focalstack', 'dffdepth', 'lightfield', 'depthio', 'dffrtp'}
WHOLE = {GObject.TYPE_INT, GObject.TYPE_UINT, GObject.TYPE_INT64, GObject.TYPE_UINT64, GObject.TYPE_LONG, GObject.TYPE_ULONG}
POINT = {GObject.TYPE_FLOAT, GObject.TYPE_DOUBLE}


def own_elements(pipeline):
    """Those of this set of plug-ins that are in the pipeline, in the order of the data."""
    found = [child for child in items(pipeline.iterate_recurse()) if child.get_factory()]
    return [child for child in reversed(found) if child.get_factory().get_plugin_name() in PLUGINS]


def kind_of(spec):
    """How the page shows it; None where it does not. Texts name files, devices and whole pipelines: these are for the command
    line, not for everybody who may look."""
    if spec.value_type == GObject.TYPE_BOOLEAN:
        return 'switch'
    if spec.value_type in WHOLE:
        return 'whole'
    if spec.value_type in POINT:
        return 'point'
    return 'choice' if spec.value_type.is_a(GObject.TYPE_ENUM) else None


def is_shown(element, spec):
    writable = spec.flags & GObject.ParamFlags.WRITABLE and not spec.flags & GObject.ParamFlags.CONSTRUCT_ONLY
    factory = Gst.ElementFactory.find(element.get_factory().get_name())
    own = spec.owner_type == factory.get_element_type()
    return bool(writable and own and spec.flags & GObject.ParamFlags.READABLE and kind_of(spec))


def value_of(element, spec):
    value = element.get_property(spec.name)
    return value.value_nick if kind_of(spec) == 'choice' else value


def described(element, spec):
    kind = kind_of(spec)
    about = {'name': spec.name, 'kind': kind, 'about': spec.blurb, 'value': value_of(element, spec),
             'running': bool(spec.flags & Gst.PARAM_MUTABLE_PLAYING)}
    if kind == 'choice':
        about['choices'] = [{'name': choice.value_nick, 'about': choice.value_name} for choice in choices_of(element, spec)]
        about['default'] = enum_of(element, spec)(int(spec.default_value)).value_nick
    elif kind != 'switch':
        about.update(least=spec.minimum, most=spec.maximum, default=spec.default_value)
    else:
        about['default'] = spec.default_value
    return without_nan(about)


def enum_of(element, spec):
    """Its class in Python. A spec's own enum_class is that up to PyGObject 3.48 only."""
    return type(element.get_property(spec.name))


def choices_of(element, spec):
    return [value for _, value in sorted(enum_of(element, spec).__enum_values__.items())]


def controls(pipeline):
    found = []
    for element in own_elements(pipeline):
        specs = [spec for spec in element.list_properties() if is_shown(element, spec)]
        if specs:
            found.append({'element': element.get_path_string(), 'name': element.get_name(), 'factory': element.get_factory().get_name(),
                          'properties': [described(element, spec) for spec in specs]})
    return found


def find(pipeline, path, name):
    for element in own_elements(pipeline):
        if element.get_path_string() == path:
            for spec in element.list_properties():
                if spec.name == name and is_shown(element, spec):
                    return element, spec
    raise Unusable(f'There is no such property: {name}')


def checked(element, spec, value):
    """The value as the property takes it."""
    kind = kind_of(spec)
    if kind == 'switch' and isinstance(value, bool):
        return value
    if kind == 'choice':
        choices = choices_of(element, spec)
        for choice in choices:
            if choice.value_nick == value:
                return choice
        raise Unusable(f'{spec.name} is one of {", ".join(choice.value_nick for choice in choices)}')
    number = isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)
    if kind == 'switch' or not number or (kind == 'whole' and value != int(value)):
        raise Unusable(f'{spec.name} cannot be {value}')
    if not spec.minimum <= value <= spec.maximum:
        raise Unusable(f'{spec.name} lies between {spec.minimum:g} and {spec.maximum:g}')
    return int(value) if kind == 'whole' else float(value)


def set_property(source, path, name, value, then):
    """Sets it; starts the source anew where it cannot be changed while it runs. `then` is called when it is set, by any thread."""
    element, spec = find(source.pipeline, path, name)
    new = checked(element, spec, value)

    def change():
        element.set_property(name, new)
        then()
    if spec.flags & Gst.PARAM_MUTABLE_PLAYING:
        change()
    else:
        source.restart_with(change)


def stats(pipeline):
    """What the elements count, by name; numbers only."""
    found = {}
    for element in own_elements(pipeline):
        if element.find_property('stats'):
            structure = element.get_property('stats')
            if structure:
                found[element.get_name()] = numbers(structure)
    return found


def numbers(structure):
    found = {}
    for place in range(structure.n_fields()):
        name = structure.nth_field_name(place)
        try:
            value = structure.get_value(name)
        except TypeError:  # arrays of numbers, which the page does not show
            continue
        if isinstance(value, (bool, int, float)):
            found[name] = value
    return without_nan(found)
