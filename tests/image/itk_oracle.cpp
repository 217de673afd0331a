#include "itk_oracle.h"

#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>

namespace vmesh::testing {
namespace {

itk::ImageIOBase::Pointer reader_for(const std::string& path) {
  if (path.ends_with(".nrrd") || path.ends_with(".nhdr")) return itk::NrrdImageIO::New().GetPointer();
  if (path.ends_with(".mha") || path.ends_with(".mhd")) return itk::MetaImageIO::New().GetPointer();
  return itk::NiftiImageIO::New().GetPointer();
}

}  // namespace

ItkPlace place_by_itk(const std::string& path) {
  const itk::ImageIOBase::Pointer io = reader_for(path);
  io->SetFileName(path);
  io->ReadImageInformation();
  ItkPlace place;
  for (unsigned a = 0; a < 3; ++a) {
    place.size[a] = io->GetDimensions(a);
    place.origin[a] = io->GetOrigin(a);
    for (unsigned b = 0; b < 3; ++b) place.steps[a][b] = io->GetDirection(a)[b] * io->GetSpacing(a);
  }
  return place;
}

}  // namespace vmesh::testing
