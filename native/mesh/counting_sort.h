// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <span>

#include "base/types.h"
#include "parallel/cancel.h"
#include "parallel/memory.h"

namespace fairing {

// Items sorted by key; equal keys keep their order.
template <class Item>
class CountingSort {
 public:
  // Item i is item_of(i), with the key key_of(i) < keys. Throws FairingError(cancelled).
  template <class KeyOf, class ItemOf>
  CountingSort(std::size_t keys, std::size_t count, const KeyOf& key_of, const ItemOf& item_of)
      : begin_(keys + 1, 0), items_(count, Item{}) {
    for (const std::size_t i : Cancellable(count)) {
      ++begin_[std::size_t(key_of(i)) + 1];
    }
    for (std::size_t k = 1; k <= keys; ++k) begin_[k] += begin_[k - 1];
    Array<Index> next(begin_.begin(), begin_.end() - 1);
    for (const std::size_t i : Cancellable(count)) {
      items_[next[key_of(i)]++] = item_of(i);
    }
  }

  std::size_t keys() const { return begin_.size() - 1; }
  std::span<Item> of(std::size_t key) {
    return {items_.data() + begin_[key], items_.data() + begin_[key + 1]};
  }

  // visit(items) for each group of items that are equal by `less`, one key at a time.
  template <class Less, class Visit>
  void for_equal(const Less& less, const Visit& visit) {
    for (const std::size_t k : Cancellable(keys())) {
      const std::span<Item> all = of(k);
      std::sort(all.begin(), all.end(), less);
      for (auto first = all.begin(); first != all.end();) {
        const auto last =
            std::find_if(first, all.end(), [&](const Item& item) { return less(*first, item); });
        visit(std::span<Item>(first, last));
        first = last;
      }
    }
  }

 private:
  Array<Index> begin_;
  Array<Item> items_;
};

}  // namespace fairing
