// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hdf5.h>

// How a growing trajectory is written, so that a process killed at any moment leaves a file that
// any HDF5 reader opens, with every row of the last flush.
//
// HDF5 changes its structures in place and in no order that would bear an interruption. This file
// driver (HDF5 1.10 Reference Manual, "Virtual File
// Layer") keeps the structures back until HDF5 asks for a flush, and then writes them so that the
// file is whole after every single write:
//   1. the file is made as long as its superblock will say, which is longer than it is: see below;
//   2. structures in places that the file on disk does not know yet, to which nothing points;
//   3. the superblock, which now counts those places as part of the file;
//   4. the old structures that point to the new ones, parents before children: a node that is split
//      keeps its entries until its parent knows where they went;
//   5. the extents of the datasets, and last what the groups contain.
// An old structure lies in one page, so that one write changes all of it or nothing: the system
// ends a write early only between pages. Rows themselves go out at once: they lie where nothing
// points to yet, or behind the extents.
//
// Another process that reads meanwhile looks at one place after another: at the superblock before a
// flush, it may be, and at the structures behind it after. HDF5 refuses what lies behind the end
// that the superblock told, and a superblock that tells an end behind the file's. So a growing
// file's superblock tells an end that is further away, the file is longer still, and both are right
// once it is closed: what is in between is a hole, which takes no place on the disk. A file of a
// killed process keeps it. What remains: who has read a tree's node before a flush that splits one
// of its children finds the rows that have moved from there to be zeros. Where the file's time has
// not changed from before it was opened until all was read, all is as one flush left it.
//
// It relies on nothing being freed and used again between two flushes: whoever makes a dataset
// shorter, or takes out links, closes the file before more is written. A group's names stay where
// they are if the one taken out does not lie beside free space, or is put in again at once and is
// the last (a short one is lost for good elsewhere, and gets another place).
//
// All trajectories are read through it too: it refuses a damaged structure for which HDF5 would
// take memory without end.
namespace tesserae::scenes::hdf5 {

/// The driver's identifier, for H5Pset_driver. Files are those of HDF5's default driver.
/// A system call that fails puts "errno = N, error message = '...'" on HDF5's error stack.
/// HDF5 takes no locks through it.
hid_t ordered_driver();

}  // namespace tesserae::scenes::hdf5
