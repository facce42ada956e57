#pragma once
#include "amontons/output/folder.h"
#include "amontons/output/pictures.h"
#include "amontons/output/record.h"
#include "amontons/solution/observer.h"

#include <nlohmann/json.hpp>

#include <filesystem>

namespace amontons
{
/// A checkpoint with what had been written when it was made.
struct SavedRun
{
  Checkpoint checkpoint;
  nlohmann::ordered_json record; ///< RunRecord::written()
  Pictures::Series series;
};

/// Writes checkpoint.cbor on process 0: CBOR (RFC 8949), numbers as they are in memory. The file is replaced in one go:
/// a run that is killed at any moment leaves the last complete one.
class CheckpointWriter : public Observer
{
public:
  /// All must outlive it; `record` and `pictures` are told of an increment before it. @param every n increments; 0:
  /// never
  CheckpointWriter(const ResultFolder &folder, int every, const RunRecord &record, const Pictures &pictures)
    : folder_(folder)
    , every_(every)
    , record_(record)
    , pictures_(pictures)
  {
  }

  [[nodiscard]] bool wants_checkpoint(int increment, bool last) const override
  {
    return every_ > 0 && (last || increment % every_ == 0);
  }
  void checkpoint(const Checkpoint &checkpoint) override;

private:
  const ResultFolder &folder_;
  int every_;
  const RunRecord &record_;
  const Pictures &pictures_;
};

/// @throws UserError if the file cannot be read or is no checkpoint of this version
SavedRun read_checkpoint(const std::filesystem::path &file);
} // namespace amontons
