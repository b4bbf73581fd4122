# SPDX-License-Identifier: GPL-3.0-or-later
"""A layout that only remembers, since real drawing needs a window."""

import bpy


class Layout:
    """Stands for UILayout: remembers labels, refuses properties and operators that do not exist."""

    def __init__(self, log=None):
        self.log = log if log is not None else []

    def row(self, **_):
        return Layout(self.log)

    column = box = split = grid_flow = row

    def panel(self, _name, **_):
        return Layout(self.log), Layout(self.log)

    def separator(self):
        pass

    def label(self, text="", **_):
        self.log.append(text)

    def prop(self, owner, name, **_):
        assert name in owner.rna_type.properties
        self.log.append(name)

    def prop_enum(self, owner, name, value, text=""):
        assert value in owner.rna_type.properties[name].enum_items
        self.log += [text, name]

    def template_icon(self, icon_value=0, **_):
        self.log.append(str(icon_value))

    def progress(self, text="", factor=0.0, **_):
        assert 0.0 <= factor <= 1.0
        self.log.append(text)

    def operator(self, name, text="", **_):
        module, function = name.split(".")
        assert function in dir(getattr(bpy.ops, module))
        self.log += [name, text] if text else [name]
        return self.button

    def menu(self, name, **_):
        assert hasattr(bpy.types, name)
        self.log.append(name)

    class button:
        """The operator properties that the panel fills in."""


def draw(cls, context=None):
    """The labels, properties and operators that a panel class draws in the present context or another one."""

    class Instance:
        layout = Layout()

    instance = Instance()
    for name in dir(cls):
        if name.startswith(("draw_", "_")) and not name.startswith("__"):
            setattr(instance, name, getattr(cls, name))
    cls.draw(instance, context or bpy.context)
    return instance.layout.log
