# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo's table: inputs, results and effort."""

# heading, width; a row is a dict of texts by heading
COLUMNS = (
    ("mesh", 10),
    ("control faces", 15),
    ("levels", 8),
    ("triangles", 11),
    ("iterations", 12),
    ("residual", 10),
    ("seconds", 9),
)


def table_row(name, control_faces, levels, triangles, report, seconds):
    """`report`: the core's; iterations and residual are those of the finest level."""
    values = (
        name,
        control_faces,
        levels,
        f"{triangles:,}",
        report["iterations"][-1],
        f"{report['residuals'][-1]:.0e}",
        f"{seconds:.2f}",
    )
    return dict(zip((heading for heading, _ in COLUMNS), map(str, values), strict=True))


def print_table(rows):
    headings = {heading: heading for heading, _ in COLUMNS}
    print()
    for row in (headings, *rows):
        first, *others = COLUMNS
        print(
            f"{row[first[0]]:<{first[1]}}"
            + "".join(f"{row[name]:>{width}}" for name, width in others)
        )
