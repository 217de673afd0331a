// Memory whose addresses ascend in the order of allocation, internal to the module. CGAL's skeletonization orders edges
// by the addresses of their records, so with ordinary memory its result would depend on what else the process has done.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <new>
#include <vector>

namespace vmesh::skeleton {

/// An arena whose chunks are reused after being given back, last in first out. During its lifetime, OrderedAllocator on
/// this thread allocates from it.
class OrderedMemory {
 public:
  /// The `bytes` are not touched before they are used, so that the system does not count them.
  explicit OrderedMemory(std::size_t bytes)
      : bytes_(bytes), block_(static_cast<std::byte*>(::operator new(bytes))), before_(current()) {
    current() = this;
  }
  ~OrderedMemory() {
    current() = before_;
    ::operator delete(block_);
  }
  OrderedMemory(const OrderedMemory&) = delete;
  OrderedMemory& operator=(const OrderedMemory&) = delete;

  static OrderedMemory*& current() {
    thread_local OrderedMemory* instance = nullptr;
    return instance;
  }

  /// Throws std::bad_alloc when the block is used up.
  void* take(std::size_t bytes) {
    bytes = rounded(bytes);
    if (auto& pieces = free_[bytes]; !pieces.empty()) {
      void* piece = pieces.back();
      pieces.pop_back();
      return piece;
    }
    if (bytes > bytes_ - used_) throw std::bad_alloc();
    void* piece = block_ + used_;
    used_ += bytes;
    return piece;
  }
  void give_back(void* piece, std::size_t bytes) { free_[rounded(bytes)].push_back(piece); }

 private:
  static std::size_t rounded(std::size_t bytes) {
    constexpr std::size_t kAlignment = alignof(std::max_align_t);
    return (bytes + kAlignment - 1) / kAlignment * kAlignment;
  }

  std::size_t bytes_, used_ = 0;
  std::byte* block_;
  OrderedMemory* before_;
  std::map<std::size_t, std::vector<void*>> free_;
};

/// An allocator on the thread's OrderedMemory, which must outlive everything allocated.
template <class T>
struct OrderedAllocator {
  using value_type = T;
  OrderedAllocator() = default;
  template <class U>
  OrderedAllocator(const OrderedAllocator<U>&) {}

  T* allocate(std::size_t count) { return static_cast<T*>(OrderedMemory::current()->take(count * sizeof(T))); }
  void deallocate(T* piece, std::size_t count) { OrderedMemory::current()->give_back(piece, count * sizeof(T)); }

  template <class U>
  bool operator==(const OrderedAllocator<U>&) const {
    return true;
  }
};

}  // namespace vmesh::skeleton
