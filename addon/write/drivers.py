# SPDX-License-Identifier: GPL-3.0-or-later
"""Drivers, copied from one data-block to another."""


def copy_drivers(source, target, prefix=""):
    """Gives `target` the drivers of `source`, a data-block of the same kind, whose path begins with `prefix`."""
    if source.animation_data is None:
        return
    for driver in source.animation_data.drivers:
        if driver.data_path.startswith(prefix) and _resolves(target, driver.data_path):
            drivers = target.animation_data_create().drivers
            old = drivers.find(driver.data_path, index=driver.array_index)
            if old is not None:
                drivers.remove(old)
            drivers.from_existing(src_driver=driver)


def _resolves(target, path):
    try:
        target.path_resolve(path)
    except ValueError:
        return False
    return True
