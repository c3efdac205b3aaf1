// SPDX-License-Identifier: Apache-2.0
#include "scenes/trajectory/trajectory_driver.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <map>
#include <memory>
#include <new>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace tesserae::scenes::hdf5 {
namespace {

/// The smallest page of any machine: what a killed write changes wholly or not at all.
constexpr haddr_t kPage = 4096;
/// Structures begin at multiples of this, usual 8, as HDF5's own alignment inside them.
constexpr haddr_t kAlignment = 8;
/// Most bytes of one system call, usual 1 GiB; Linux moves at most 2 GiB - 4 KiB.
constexpr std::size_t kMostBytes = std::size_t{1} << 30;
/// The longest address that off_t holds.
constexpr haddr_t kMostAddress = (haddr_t{1} << 63) - 1;

/// Where a superblock of version 0 holds the file's end.
constexpr std::size_t kEndAt = 40;
/// Bytes at the beginning of a group's names, and most bytes of these: more than 10,000 long ones.
constexpr std::size_t kHeapBytes = 32, kMostNameBytes = 4 << 20;

/// A growing file's superblock says that it ends further behind than it does, by an eighth of it
/// and 1 MiB, at most 64 MiB: what a reader that has looked at the superblock already finds to have
/// been added meanwhile shall lie within. Less: more readers fail amid a flush. More: files look
/// larger, though what is not written takes no place on the disk.
constexpr haddr_t kLeastRoom = 1 << 20, kMostRoom = 64 << 20, kRoomPart = 8;

using Bytes = std::vector<unsigned char>;

/// A structure that HDF5 has given out but that is not in the file yet.
struct Piece {
    H5FD_mem_t type;
    Bytes bytes;
};

/// An open file. HDF5 keeps its own part in the base.
struct OrderedFile : H5FD_t {
    int descriptor = -1;
    dev_t device = 0;
    ino_t inode = 0;
    haddr_t end = 0;        ///< of what is allocated
    haddr_t known_end = 0;  ///< by HDF5's superblock at the last flush
    haddr_t said_end = 0;   ///< by the superblock that is in the file
    std::map<haddr_t, Piece> held;
    int broken = 0;  ///< errno of the first write that failed: nothing after it reaches the file
};

OrderedFile& ordered(H5FD_t* file) { return *static_cast<OrderedFile*>(file); }
const OrderedFile& ordered(const H5FD_t* file) { return *static_cast<const OrderedFile*>(file); }

/// Puts a failure on HDF5's stack. @return -1
herr_t failed(const char* text) {
    H5Epush2(H5E_DEFAULT, __FILE__, __func__, __LINE__, H5E_ERR_CLS, H5E_VFL, H5E_BADVALUE, "%s",
             text);
    return -1;
}

/// The same of a system call, in the words of HDF5's own drivers.
herr_t failed_call(int error) {
    const std::string text = std::generic_category().message(error);
    H5Epush2(H5E_DEFAULT, __FILE__, __func__, __LINE__, H5E_ERR_CLS, H5E_VFL, H5E_SYSERRSTR,
             "errno = %d, error message = '%s'", error, text.c_str());
    return -1;
}

/// Calls pread or pwrite until all is moved.
/// @return bytes moved, fewer only at the file's end; -1 on failure, with errno
template <class Call, class Byte>
ssize_t move_all(Call call, int descriptor, Byte* bytes, std::size_t size, haddr_t at) {
    std::size_t moved = 0;
    while (moved < size) {
        const ssize_t result = call(descriptor, bytes + moved, std::min(size - moved, kMostBytes),
                                    static_cast<off_t>(at + moved));
        if (result < 0 && errno == EINTR) continue;
        if (result < 0) return -1;
        if (result == 0) break;
        moved += static_cast<std::size_t>(result);
    }
    return static_cast<ssize_t>(moved);
}

herr_t write_now(OrderedFile& f, haddr_t at, const unsigned char* bytes, std::size_t size) {
    if (f.broken != 0) return failed_call(f.broken);
    const ssize_t moved = move_all(::pwrite, f.descriptor, bytes, size, at);
    if (moved >= 0 && static_cast<std::size_t>(moved) == size) return 0;
    f.broken = moved < 0 ? errno : ENOSPC;
    return failed_call(f.broken);
}

/// @return errno, 0 if done
int change_length(const OrderedFile& f, haddr_t length) {
    int result;
    do result = ::ftruncate(f.descriptor, static_cast<off_t>(length));
    while (result < 0 && errno == EINTR);
    return result == 0 ? 0 : errno;
}

herr_t set_length(OrderedFile& f, haddr_t length) {
    if (f.broken == 0) f.broken = change_length(f, length);
    return f.broken == 0 ? 0 : failed_call(f.broken);
}

/// @return the file's length; HADDR_UNDEF on failure
haddr_t length_of(const OrderedFile& f) {
    struct stat status;
    if (::fstat(f.descriptor, &status) == 0) return static_cast<haddr_t>(status.st_size);
    failed_call(errno);
    return HADDR_UNDEF;
}

std::uint64_t word_at(const unsigned char* bytes) {
    static_assert(std::endian::native == std::endian::little);
    std::uint64_t word;
    std::memcpy(&word, bytes, sizeof word);
    return word;
}

/// The file's end as a superblock of version 0 tells it (HDF5 File Format Specification 3.0, II.A).
haddr_t end_in(const unsigned char* superblock) { return word_at(superblock + kEndAt); }

void put_end(unsigned char* superblock, haddr_t end) {
    std::memcpy(superblock + kEndAt, &end, sizeof end);
}

haddr_t with_room(haddr_t end) { return end + std::min(kLeastRoom + end / kRoomPart, kMostRoom); }

/// The order of structures that are in the file already: names, tree nodes from the root down, the
/// headers that hold extents, and last the tables of groups, which point to names and headers.
std::pair<int, int> order_of(const Piece& piece) {
    const auto begins = [&](const char* signature) {
        return piece.bytes.size() >= 8 && std::memcmp(piece.bytes.data(), signature, 4) == 0;
    };
    if (begins("TREE")) return {1, -static_cast<int>(piece.bytes[5])};
    if (begins("SNOD")) return {3, 0};
    return {piece.type == H5FD_MEM_LHEAP ? 0 : 2, 0};
}

/// Writes what is held, in the order that trajectory_driver.hpp gives.
herr_t write_held(OrderedFile& f) {
    if (f.held.empty()) return 0;
    using Entry = std::pair<const haddr_t, Piece>;
    std::vector<const Entry*> fresh, old;
    Entry* superblock = nullptr;
    for (Entry& entry : f.held) {
        if (entry.second.type == H5FD_MEM_SUPER)
            superblock = &entry;
        else
            (entry.first >= f.known_end ? fresh : old).push_back(&entry);
    }
    std::stable_sort(old.begin(), old.end(), [](const Entry* a, const Entry* b) {
        return order_of(a->second) < order_of(b->second);
    });
    // A file that gets shorter keeps its old end until nothing points behind the new one.
    const haddr_t end = superblock ? end_in(superblock->second.bytes.data()) : f.known_end;
    std::vector<const Entry*> order = std::move(fresh);
    if (superblock && end >= f.known_end) order.push_back(superblock);
    order.insert(order.end(), old.begin(), old.end());
    if (superblock && end < f.known_end) order.push_back(superblock);

    // A reader asks for the length before it reads the superblock: the length is ahead of that.
    // Where files may not be so long there is no room.
    haddr_t said = superblock ? with_room(end) : f.said_end;
    const haddr_t bytes = length_of(f);
    if (bytes == HADDR_UNDEF) return -1;
    if (bytes < with_room(said) && change_length(f, with_room(said)) != 0) {
        if (superblock) said = end;
        if (bytes < said && set_length(f, said) < 0) return -1;
    }
    if (superblock) put_end(superblock->second.bytes.data(), said);
    for (const Entry* entry : order)
        if (write_now(f, entry->first, entry->second.bytes.data(), entry->second.bytes.size()) < 0)
            return -1;
    f.known_end = end;
    f.said_end = said;
    f.held.clear();
    return 0;
}

/// Changes the end in the superblock alone.
herr_t say_end(OrderedFile& f, haddr_t end) {
    unsigned char bytes[sizeof end];
    std::memcpy(bytes, &end, sizeof end);
    if (write_now(f, kEndAt, bytes, sizeof bytes) < 0) return -1;
    f.said_end = end;
    return 0;
}

H5FD_t* open_ordered(const char* name, unsigned flags, hid_t, haddr_t) try {
    int mode = (flags & H5F_ACC_RDWR) != 0 ? O_RDWR : O_RDONLY;
    if ((flags & H5F_ACC_TRUNC) != 0) mode |= O_TRUNC;
    if ((flags & H5F_ACC_CREAT) != 0) mode |= O_CREAT;
    if ((flags & H5F_ACC_EXCL) != 0) mode |= O_EXCL;
    auto file = std::make_unique<OrderedFile>();
    do file->descriptor = ::open(name, mode | O_CLOEXEC, 0666);
    while (file->descriptor < 0 && errno == EINTR);
    struct stat status;
    unsigned char superblock[kEndAt + sizeof(haddr_t)];
    ssize_t moved = -1;
    if (file->descriptor >= 0 && ::fstat(file->descriptor, &status) == 0)
        moved = move_all(::pread, file->descriptor, superblock, sizeof superblock, 0);
    if (moved < 0) {
        failed_call(errno);
        if (file->descriptor >= 0) ::close(file->descriptor);
        return nullptr;
    }
    file->device = status.st_dev;
    file->inode = status.st_ino;
    if (static_cast<std::size_t>(moved) == sizeof superblock)
        file->known_end = file->said_end = end_in(superblock);
    return file.release();
} catch (const std::bad_alloc&) {
    failed("no memory");
    return nullptr;
}

/// What is held by now is what a failure left: HDF5 has asked for its last flush.
herr_t close_ordered(H5FD_t* file) {
    const std::unique_ptr<OrderedFile> f(&ordered(file));
    return ::close(f->descriptor) == 0 || errno == EINTR ? 0 : failed_call(errno);
}

int compare(const H5FD_t* a, const H5FD_t* b) {
    const auto key = [](const OrderedFile& f) { return std::pair(f.device, f.inode); };
    if (key(ordered(a)) == key(ordered(b))) return 0;
    return key(ordered(a)) < key(ordered(b)) ? -1 : 1;
}

herr_t query(const H5FD_t*, unsigned long* flags) {
    // Nothing that gathers structures of several kinds, or gives out places before they are used.
    *flags = H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
    return 0;
}

haddr_t allocate(H5FD_t* file, H5FD_mem_t type, hid_t, hsize_t size) {
    OrderedFile& f = ordered(file);
    if (size > kMostAddress - f.end - kPage) return HADDR_UNDEF;
    haddr_t at = (f.end + kAlignment - 1) / kAlignment * kAlignment;
    const bool crosses = at / kPage != (at + size - 1) / kPage;
    if (type != H5FD_MEM_DRAW && size <= kPage && crosses) at = (at / kPage + 1) * kPage;
    f.end = at + size;
    return at;
}

haddr_t allocated_end(const H5FD_t* file, H5FD_mem_t) { return ordered(file).end; }

herr_t set_allocated_end(H5FD_t* file, H5FD_mem_t, haddr_t end) {
    ordered(file).end = end;
    return 0;
}

haddr_t length(const H5FD_t* file, H5FD_mem_t) { return length_of(ordered(file)); }

/// Reads what is held, and else the file.
/// @return bytes read, fewer only at the file's end; -1 on failure, with errno
ssize_t read_now(const OrderedFile& f, haddr_t at, std::size_t size, unsigned char* bytes) {
    const ssize_t moved = move_all(::pread, f.descriptor, bytes, size, at);
    if (moved < 0) return moved;
    // Allocated but never written: zeros, as in HDF5's own drivers.
    std::memset(bytes + moved, 0, size - static_cast<std::size_t>(moved));
    // What is held is newer.
    auto piece = f.held.upper_bound(at);
    if (piece != f.held.begin()) --piece;
    for (; piece != f.held.end() && piece->first < at + size; ++piece) {
        const Bytes& held = piece->second.bytes;
        const haddr_t begin = std::max(at, piece->first);
        const haddr_t end = std::min<haddr_t>(at + size, piece->first + held.size());
        if (begin < end)
            std::memcpy(bytes + (begin - at), held.data() + (begin - piece->first), end - begin);
    }
    return moved;
}

/// Returns whether the free places among a group's names lie within these, one behind the other.
/// @param place   the first
bool are_sound_places(const Bytes& names, std::uint64_t place) {
    constexpr std::uint64_t kNoPlace = 1, kPlaceBytes = 16;
    std::uint64_t count = 0;
    for (; place != kNoPlace; place = word_at(&names[place])) {
        if (names.size() < kPlaceBytes || place > names.size() - kPlaceBytes) return false;
        if (word_at(&names[place + 8]) > names.size() - place) return false;
        if (++count > names.size() / kPlaceBytes) return false;
    }
    return true;
}

/// Refuses a group's names that do not lie within the file, or whose free places are damaged. HDF5
/// would write beyond its memory, or follow a circle of free places for ever and take memory for
/// each (HDF5 File Format Specification 3.0, III.D).
/// @param heap   where a group's names begin; kHeapBytes
herr_t check_heap(const OrderedFile& f, const unsigned char* heap) {
    constexpr const char* kDamaged = "a group's names are damaged";
    const std::uint64_t size = word_at(heap + 8), address = word_at(heap + 24);
    const haddr_t bytes = length_of(f), end = std::max(f.end, bytes);
    if (bytes == HADDR_UNDEF) return -1;
    if (size > kMostNameBytes || size > end || address > end - size) return failed(kDamaged);
    Bytes names(size);
    if (read_now(f, address, size, names.data()) < 0) return failed_call(errno);
    return are_sound_places(names, word_at(heap + 16)) ? 0 : failed(kDamaged);
}

herr_t read(H5FD_t* file, H5FD_mem_t type, hid_t, haddr_t at, std::size_t size, void* buffer) try {
    const OrderedFile& f = ordered(file);
    auto* bytes = static_cast<unsigned char*>(buffer);
    if (read_now(f, at, size, bytes) < 0) return failed_call(errno);
    const bool is_heap =
        type == H5FD_MEM_LHEAP && size >= kHeapBytes && std::memcmp(bytes, "HEAP", 4) == 0;
    return is_heap ? check_heap(f, bytes) : 0;
} catch (const std::bad_alloc&) {
    return failed("no memory");
}

herr_t write(H5FD_t* file, H5FD_mem_t type, hid_t, haddr_t at, std::size_t size,
             const void* buffer) try {
    OrderedFile& f = ordered(file);
    const auto* bytes = static_cast<const unsigned char*>(buffer);
    if (type == H5FD_MEM_DRAW) return write_now(f, at, bytes, size);
    const auto after = f.held.upper_bound(at);
    const bool behind = after != f.held.begin() && std::prev(after)->first != at &&
                        std::prev(after)->first + std::prev(after)->second.bytes.size() > at;
    if (behind || (after != f.held.end() && at + size > after->first))
        return failed("a structure overlaps another that is not written yet");
    f.held.insert_or_assign(at, Piece{type, Bytes(bytes, bytes + size)});
    return 0;
} catch (const std::bad_alloc&) {
    return failed("no memory");
}

herr_t flush(H5FD_t* file, hid_t, hbool_t) { return write_held(ordered(file)); }

/// HDF5 asks for this in every flush, but while closing it is its last word.
herr_t truncate(H5FD_t* file, hid_t, hbool_t closing) {
    OrderedFile& f = ordered(file);
    if (!closing) return 0;
    if (write_held(f) < 0) return -1;
    // Nobody adds to it any more: its end is where it is.
    if (f.said_end != f.known_end && say_end(f, f.known_end) < 0) return -1;
    const haddr_t bytes = length_of(f), end = std::max(f.end, f.known_end);
    if (bytes == HADDR_UNDEF) return -1;
    return bytes == end ? 0 : set_length(f, end);
}

H5FD_class_t driver_class() {
    H5FD_class_t driver = {};
#ifdef H5FD_CLASS_VERSION
    // HDF5 1.14 wants these; 256 to 511 are for drivers that are not registered with it.
    driver.version = H5FD_CLASS_VERSION;
    driver.value = H5_VFD_RESERVED;
#endif
    driver.name = "tesserae_ordered";
    driver.maxaddr = kMostAddress;
    driver.fc_degree = H5F_CLOSE_STRONG;
    driver.open = open_ordered;
    driver.close = close_ordered;
    driver.cmp = compare;
    driver.query = query;
    driver.alloc = allocate;
    driver.get_eoa = allocated_end;
    driver.set_eoa = set_allocated_end;
    driver.get_eof = length;
    driver.read = read;
    driver.write = write;
    driver.flush = flush;
    driver.truncate = truncate;
    const H5FD_mem_t map[] = H5FD_FLMAP_DICHOTOMY;
    std::copy(std::begin(map), std::end(map), driver.fl_map);
    return driver;
}

}  // namespace

hid_t ordered_driver() {
    static const H5FD_class_t driver = driver_class();
    static const hid_t id = H5FDregister(&driver);
    return id;
}

}  // namespace tesserae::scenes::hdf5
