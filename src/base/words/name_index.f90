!> A list of names with fast, case-insensitive search.
module name_index
  use kinds, only: long
  use text, only: lower_case, same_word, string_t
  implicit none (type, external)
  private

  public :: name_index_t, new_name_index, find_name

  !> Names with a chained hash table.
  type :: name_index_t
    type(string_t), allocatable :: name(:)   !! (names) as the user spells them
    integer, allocatable, private :: head(:) !! (buckets) first name of each, 0 for none
    integer, allocatable, private :: next(:) !! (names) the next one in its bucket, 0 for none
  end type name_index_t

contains

  !> Builds the hash table of a list of names.
  pure function new_name_index(names) result(list)
    type(string_t), intent(in) :: names(:) !! equal ones are allowed
    type(name_index_t) :: list

    integer :: i, bucket

    allocate (list%name(size(names)), list%head(max(1, 2*size(names))), list%next(size(names)))
    list%name = names
    list%head = 0
    ! Backwards, so that every chain begins with its earliest name: of equal names, the first is
    ! found.
    do i = size(names), 1, -1
      bucket = bucket_of(names(i)%text, size(list%head))
      list%next(i) = list%head(bucket)
      list%head(bucket) = i
    end do
  end function new_name_index

  !> Number of the first name in the list that equals `name`, ignoring case; 0 if there is none.
  pure function find_name(list, name) result(number)
    type(name_index_t), intent(in) :: list !! to search
    character(len=*), intent(in) :: name   !! in any case of letters
    integer :: number

    number = list%head(bucket_of(name, size(list%head)))
    do while (number > 0)
      if (same_word(list%name(number)%text, name)) return
      number = list%next(number)
    end do
  end function find_name

  !> FNV-1a hash of the lower-case name, folded into the buckets.
  pure function bucket_of(name, buckets) result(bucket)
    character(len=*), intent(in) :: name
    integer, intent(in) :: buckets
    integer :: bucket

    integer(long), parameter :: prime = 16777619_long, modulus = 4294967296_long
    character(len=:), allocatable :: key
    integer(long) :: hash
    integer :: i

    key = lower_case(name)
    hash = 2166136261_long
    do i = 1, len(key)
      hash = mod(ieor(hash, int(ichar(key(i:i)), long))*prime, modulus)
    end do
    bucket = 1 + int(mod(hash, int(buckets, long)))
  end function bucket_of

end module name_index
