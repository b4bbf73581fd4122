# SPDX-License-Identifier: GPL-3.0-or-later
"""Node trees without the ceremony."""

import bpy

TAG = "fairing_inspection"  # custom property of what this add-on made: it is found again by this, not by its name


class Graph:
    """Adds nodes to a tree; inputs may be sockets to link or plain values."""

    def __init__(self, tree):
        self.tree = tree
        tree.nodes.clear()

    def node(self, kind, name="", inputs=(), **settings):
        """A node with its properties `settings` and `inputs`: a dict by socket name or position."""
        node = self.tree.nodes.new(kind)
        if name:
            node.name = node.label = name
        for key, value in settings.items():
            setattr(node, key, value)
        for key, value in dict(inputs).items():
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, node.inputs[key])
            else:
                node.inputs[key].default_value = value
        return node

    def math(self, operation, first, second=0.0, name=""):
        return self.node("ShaderNodeMath", name, {0: first, 1: second}, operation=operation).outputs[0]


def tagged(collection, mode):
    """The member of a bpy.data collection that was made for `mode`, or None."""
    return next((item for item in collection if item.get(TAG) == mode and item.library is None), None)


def lay_out(tree):
    """Nodes in columns by how far they are from the output, for those who look inside."""
    depth = {}

    def visit(node, at):
        if depth.get(node.name, -1) < at:
            depth[node.name] = at
            for socket in node.inputs:
                for link in socket.links:
                    visit(link.from_node, at + 1)

    for node in tree.nodes:
        if not any(socket.is_linked for socket in node.outputs):
            visit(node, 0)
    filled = {}
    for node in tree.nodes:
        column = depth.get(node.name, 0)
        node.location = (-220 * column, -220 * filled.get(column, 0))
        filled[column] = filled.get(column, 0) + 1
