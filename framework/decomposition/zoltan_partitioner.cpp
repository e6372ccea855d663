// SPDX-License-Identifier: BSD-3-Clause
#include "framework/decomposition/zoltan_partitioner.hpp"

#include <mpi.h>

#include <algorithm>
#include <optional>

#include "framework/comm/mpi_access.hpp"

namespace tenon {

namespace {

constexpr int id_words = 2;  // rank and place there: Zoltan's ids are of 32 bits

void write_id(ZOLTAN_ID_TYPE* id, int rank, LocalIndex index) {
  id[0] = static_cast<ZOLTAN_ID_TYPE>(rank);
  id[1] = static_cast<ZOLTAN_ID_TYPE>(index);
}

}  // namespace

// What Zoltan asks for, answered from the spans of the partition at work.
struct ZoltanCallbacks {
  static const ZoltanPartitioner& self(void* data) { return *static_cast<const ZoltanPartitioner*>(data); }

  static int item_count(void* data, int* error) {
    *error = ZOLTAN_OK;
    return static_cast<int>(self(data).items_.coordinates.size());
  }

  static void item_list(void* data, int, int, ZOLTAN_ID_PTR ids, ZOLTAN_ID_PTR, int weight_words, float* weights,
                        int* error) {
    *error = ZOLTAN_OK;
    const ZoltanPartitioner& me = self(data);
    for (std::size_t i = 0; i < me.items_.coordinates.size(); ++i) {
      write_id(ids + i * id_words, me.rank_, static_cast<LocalIndex>(i));
      if (weight_words > 0) weights[i] = static_cast<float>(me.items_.weights[i]);
    }
  }

  // Only items whose part is another than this are reported.
  static void parts(void* data, int, int, int count, ZOLTAN_ID_PTR, ZOLTAN_ID_PTR, int* part, int* error) {
    *error = ZOLTAN_OK;
    std::fill_n(part, count, self(data).assumed_part_);
  }

  static int dimensions(void*, int* error) {
    *error = ZOLTAN_OK;
    return 3;
  }

  static void coordinates(void* data, int, int, int count, ZOLTAN_ID_PTR ids, ZOLTAN_ID_PTR, int, double* xyz,
                          int* error) {
    *error = ZOLTAN_OK;
    const ZoltanPartitioner& me = self(data);
    for (int i = 0; i < count; ++i) {
      const Vec3& x = me.items_.coordinates[ids[i * id_words + 1]];
      std::copy(x.begin(), x.end(), xyz + 3 * i);
    }
  }

  static void edge_counts(void* data, int, int, int count, ZOLTAN_ID_PTR ids, ZOLTAN_ID_PTR, int* edges, int* error) {
    *error = ZOLTAN_OK;
    const std::span<const LocalIndex> offsets = self(data).items_.offsets;
    for (int i = 0; i < count; ++i) {
      const std::size_t item = ids[i * id_words + 1];
      edges[i] = offsets[item + 1] - offsets[item];
    }
  }

  static void edge_lists(void* data, int, int, int count, ZOLTAN_ID_PTR ids, ZOLTAN_ID_PTR, int*, ZOLTAN_ID_PTR to,
                         int* to_rank, int, float*, int* error) {
    *error = ZOLTAN_OK;
    const PartitionItems& items = self(data).items_;
    for (int i = 0; i < count; ++i) {
      const std::size_t item = ids[i * id_words + 1];
      for (LocalIndex e = items.offsets[item]; e < items.offsets[item + 1]; ++e) {
        const auto edge = static_cast<std::size_t>(e);
        *to_rank++ = items.neighbour_rank[edge];
        write_id(to, items.neighbour_rank[edge], items.neighbour_index[edge]);
        to += id_words;
      }
    }
  }
};

ZoltanPartitioner::ZoltanPartitioner(const Communicator& comm, int parts)
    : comm_(comm), rank_(comm.rank()), assumed_part_(parts == comm.size() ? rank_ : 0) {
  float version = 0;
  Zoltan_Initialize(0, nullptr, &version);
  zoltan_ = Zoltan_Create(mpi_communicator(comm));
  comm.throw_if_any(zoltan_ ? std::nullopt : std::optional(Error(ExitCode::usage, "Zoltan cannot be started")));
  set("DEBUG_LEVEL", "0");
  set("NUM_GLOBAL_PARTS", std::to_string(parts));
  set("NUM_GID_ENTRIES", "2");
  set("NUM_LID_ENTRIES", "0");
  set("REMAP", "0");
  set("RETURN_LISTS", "EXPORT");  // PARTS fails where a rank has no items before and after
  Zoltan_Set_Num_Obj_Fn(zoltan_, ZoltanCallbacks::item_count, this);
  Zoltan_Set_Obj_List_Fn(zoltan_, ZoltanCallbacks::item_list, this);
  Zoltan_Set_Part_Multi_Fn(zoltan_, ZoltanCallbacks::parts, this);
  Zoltan_Set_Num_Geom_Fn(zoltan_, ZoltanCallbacks::dimensions, this);
  Zoltan_Set_Geom_Multi_Fn(zoltan_, ZoltanCallbacks::coordinates, this);
  Zoltan_Set_Num_Edges_Multi_Fn(zoltan_, ZoltanCallbacks::edge_counts, this);
  Zoltan_Set_Edge_List_Multi_Fn(zoltan_, ZoltanCallbacks::edge_lists, this);
}

ZoltanPartitioner::~ZoltanPartitioner() {
  int finalised = 0;
  MPI_Finalized(&finalised);
  if (!finalised) Zoltan_Destroy(&zoltan_);
}

void ZoltanPartitioner::set(const std::string& parameter, const std::string& value) {
  if (Zoltan_Set_Param(zoltan_, parameter.c_str(), value.c_str()) != ZOLTAN_OK)
    throw Error(ExitCode::usage, "Zoltan refuses " + parameter + " = " + value + ": was it built without it?");
}

std::vector<int> ZoltanPartitioner::partition(const PartitionItems& items) {
  items_ = items;
  set("OBJ_WEIGHT_DIM", comm_.any(!items.weights.empty()) ? "1" : "0");
  int changes = 0, gid_words = 0, lid_words = 0, imports = 0, exports = 0;
  ZOLTAN_ID_PTR import_ids = nullptr, import_lids = nullptr, export_ids = nullptr, export_lids = nullptr;
  int *import_ranks = nullptr, *import_parts = nullptr, *export_ranks = nullptr, *export_parts = nullptr;
  const int status =
      Zoltan_LB_Partition(zoltan_, &changes, &gid_words, &lid_words, &imports, &import_ids, &import_lids, &import_ranks,
                          &import_parts, &exports, &export_ids, &export_lids, &export_ranks, &export_parts);
  std::vector<int> part(items.coordinates.size(), assumed_part_);
  for (int i = 0; i < exports; ++i) part[export_ids[i * id_words + 1]] = export_parts[i];
  Zoltan_LB_Free_Part(&import_ids, &import_lids, &import_ranks, &import_parts);
  Zoltan_LB_Free_Part(&export_ids, &export_lids, &export_ranks, &export_parts);
  items_ = {};
  const bool failed = status != ZOLTAN_OK && status != ZOLTAN_WARN;
  comm_.throw_if_any(failed ? std::optional(Error(ExitCode::usage,
                                                  "Zoltan failed to partition (status " + std::to_string(status) + ")"))
                            : std::nullopt);
  return part;
}

}  // namespace tenon
