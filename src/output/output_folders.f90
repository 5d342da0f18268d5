!> The folder of a run's outputs: files appear in it only when all are complete, and all together.
!!
!! A run holds the lock of its folder and writes into a folder of its own in it. When all files are
!! there, that folder is renamed to `.finished`, which decides: whatever happens then, its files
!! are put in place, by this run or by the next one that takes the lock. Meanwhile there is no
!! `summary.json`: it goes first, and comes last.
module output_folders
  use errors, only: error_of_files, error_t, set_error
  use file_system, only: file_exists, find_matching_files, folder_name, file_name, is_directory, &
    is_plain_file, joined_path, make_directories, make_own_directory, read_text, real_path, &
    remove_directory, remove_empty_directory, remove_file, rename_file, system_reason
  use folder_locks, only: leave_lock, lock_t, take_lock
  use json_text, only: json_value
  use program_version, only: program_name
  use text, only: append_string, is_among, string_t
  implicit none (type, external)
  private

  public :: output_folder_t, open_folder, begin_files, refuse_names, put_in_place, &
    leave_folder, discard_folder
  public :: echo_name, log_name, summary_name

  type :: output_folder_t
    character(len=:), allocatable :: path
    character(len=:), allocatable :: own               !! of this run's files until they are put in
                                                       !! place; not allocated: none
    type(string_t), allocatable, private :: is_new(:)  !! folders that this run made, outermost
                                                       !! first
    type(lock_t), private :: lock
  end type output_folder_t

  !> Files beside the tables.
  character(len=*), parameter :: echo_name = "echo.deck", log_name = "run.log", &
    summary_name = "summary.json"

  character(len=*), parameter :: own_beginning = ".new-", finished_name = ".finished", &
    previous_name = "previous.json"

contains

  !> Makes the folder and takes its lock, or that of one file in it. Errors: it cannot be made or
  !! written to, another run has the lock.
  subroutine open_folder(path, file, folder, error)
    character(len=*), intent(in) :: path             !! may not exist
    character(len=*), intent(in) :: file             !! the only one to be written; empty: all of
                                                     !! them
    type(output_folder_t), intent(out) :: folder     !! to be discarded after an error
    type(error_t), allocatable, intent(out) :: error !! why nothing can be written

    integer, parameter :: most_tries = 100
    character(len=:), allocatable :: holder, reason
    type(string_t), allocatable :: is_new(:)
    logical :: made
    integer :: try

    folder%path = path
    allocate (folder%is_new(0))
    ! Another run may remove the folder that it made before the lock is taken.
    do try = 1, most_tries
      call make_directories(path, made, is_new)
      if (size(is_new) > 0) folder%is_new = is_new
      if (.not. made) then
        call set_error(error, error_of_files, "this folder cannot be created: "//system_reason(), &
          path)
        return
      end if
      call take_lock(joined_path(path, "."//file//trim(merge("lock ", ".lock", file == ""))), &
        folder%lock, holder, reason)
      if (folder%lock%is_held) return
      if (holder /= "") exit
      if (is_directory(path)) then
        call set_error(error, error_of_files, "nothing can be written to this folder: "//reason, &
          path)
        return
      end if
    end do
    call set_error(error, error_of_files, "another run is writing to this folder ("//holder// &
      "): wait for its end, or choose another folder with --out", path)
  end subroutine open_folder

  !> Puts in place what an earlier run had finished, removes what others have left, and makes the
  !! folder of this run's files. Errors: it cannot be made, or files cannot be put in place.
  subroutine begin_files(folder, error)
    type(output_folder_t), intent(inout) :: folder   !! opened, with the lock of all files
    type(error_t), allocatable, intent(out) :: error

    type(string_t), allocatable :: left(:)
    logical :: made
    integer :: i

    call carry_out(folder%path, error)
    if (allocated(error)) return
    if (folder%lock%is_sure) then
      call find_matching_files(folder%path, own_beginning, left)
      do i = 1, size(left)
        call remove_directory(joined_path(folder%path, left(i)%text))
      end do
    end if
    call make_own_directory(joined_path(folder%path, own_beginning), folder%own, made)
    if (made) return
    call set_error(error, error_of_files, "nothing can be written to this folder: "// &
      system_reason(), folder%path)
    deallocate (folder%own)
  end subroutine begin_files

  !> Errors: a file that is to be written is a folder or a pipe, one that the deck was read from, or
  !! somebody else's: no earlier run has written it.
  subroutine refuse_names(folder, names, journals, inputs, error)
    type(output_folder_t), intent(in) :: folder        !! opened
    type(string_t), intent(in) :: names(:)             !! of the files
    type(string_t), intent(in) :: journals(:)          !! of those that a killed run may have left
    type(string_t), intent(in) :: inputs(:)            !! paths of the deck, of what it includes, of
                                                       !! its tables
    type(error_t), allocatable, intent(inout) :: error !! as it was if there is none

    type(string_t), allocatable :: earlier(:), places(:)
    character(len=:), allocatable :: home
    integer :: i

    allocate (places(0))
    do i = 1, size(inputs)
      ! A link is replaced itself, not what it leads to; but it, too, is the user's.
      call append_string(places, joined_path(real_path(folder_name(inputs(i)%text)), &
        file_name(inputs(i)%text)))
      call append_string(places, real_path(inputs(i)%text))
    end do
    home = real_path(folder%path)
    call names_of_summary(joined_path(folder%path, summary_name), folder%path, earlier)
    do i = 1, size(names)
      call refuse_name(names(i)%text)
      if (allocated(error)) return
      if (is_among(earlier, names(i)%text)) cycle
      if (file_exists(joined_path(folder%path, names(i)%text))) call set_error(error, &
        error_of_files, "a file is to be written there, and this one is not of an earlier run "// &
        "of the deck: move it, or choose another folder with --out", joined_path(folder%path, &
        names(i)%text))
    end do
    do i = 1, size(journals)
      call refuse_name(journals(i)%text)
    end do

  contains

    subroutine refuse_name(name)
      character(len=*), intent(in) :: name

      character(len=:), allocatable :: path
      integer :: k

      if (allocated(error)) return
      path = joined_path(folder%path, name)
      if (is_directory(path)) then
        call set_error(error, error_of_files, "this is a folder, and a file is to be written "// &
          "there", path)
      else if (file_exists(path) .and. .not. is_plain_file(path)) then
        call set_error(error, error_of_files, "this is a pipe or a device, and a file is to be "// &
          "written there", path)
      end if
      do k = 1, size(places)
        if (places(k)%text /= joined_path(home, name)) cycle
        call set_error(error, error_of_files, "this file belongs to the deck, and a result of "// &
          "its name is to be written there: rename it, or choose another folder with --out", &
          inputs((k + 1)/2)%text)
        return
      end do
    end subroutine refuse_name

  end subroutine refuse_names

  !> Puts the files of the run's own folder in place, and removes those of an earlier run that are
  !! not among them. Errors: it cannot be done; what has begun is carried out by the next run.
  subroutine put_in_place(folder, error)
    type(output_folder_t), intent(inout) :: folder   !! with all files, complete
    type(error_t), allocatable, intent(out) :: error

    logical :: done

    call rename_file(folder%own, joined_path(folder%path, finished_name), done)
    if (done) then
      deallocate (folder%own)
      call carry_out(folder%path, error)
    else
      call set_error(error, error_of_files, "the files cannot be put in place: "// &
        system_reason(), folder%path)
    end if
  end subroutine put_in_place

  !> Carries out what a run has decided, from wherever it was left. Nothing happens if there is no
  !! such decision. Errors: a file cannot be renamed.
  subroutine carry_out(path, error)
    character(len=*), intent(in) :: path !! of the folder
    type(error_t), allocatable, intent(out) :: error

    type(string_t), allocatable :: earlier(:), names(:), of_run(:)
    character(len=:), allocatable :: finished
    integer :: i

    finished = joined_path(path, finished_name)
    if (.not. is_directory(finished)) return
    if (file_exists(joined_path(finished, summary_name))) then
      if (file_exists(joined_path(path, summary_name))) &
        call move_file(joined_path(path, summary_name), joined_path(finished, previous_name), error)
      call names_of_summary(joined_path(finished, previous_name), path, earlier)
      call names_of_summary(joined_path(finished, summary_name), path, of_run)
      do i = 1, size(earlier)
        if (.not. is_among(of_run, earlier(i)%text)) call remove_file(joined_path(path, &
          earlier(i)%text))
      end do
      call find_matching_files(finished, "", names)
      do i = 1, size(names)
        if (allocated(error)) return
        if (names(i)%text == previous_name .or. names(i)%text == summary_name) cycle
        call move_file(joined_path(finished, names(i)%text), joined_path(path, names(i)%text), &
          error)
      end do
      if (.not. allocated(error)) call move_file(joined_path(finished, summary_name), &
        joined_path(path, summary_name), error)
    end if
    if (.not. allocated(error)) call remove_directory(finished)
  end subroutine carry_out

  subroutine move_file(from, to, error)
    character(len=*), intent(in) :: from, to
    type(error_t), allocatable, intent(inout) :: error

    logical :: done

    call rename_file(from, to, done)
    if (.not. done) call set_error(error, error_of_files, "the file cannot be put in place: "// &
      system_reason(), to)
  end subroutine move_file

  !> The files that a summary says its run has written, itself among them; none if it is no summary
  !! of this deck.
  subroutine names_of_summary(path, folder, names)
    character(len=*), intent(in) :: path   !! of the summary, which may not exist
    character(len=*), intent(in) :: folder !! of the outputs, which has the name of the deck
    type(string_t), allocatable, intent(out) :: names(:)

    !> What stands before the names of a table's files, and of a summary.
    character(len=*), parameter :: keys(*) = [character(len=10) :: '"file": "', '"csv": "'], &
      beginning = '{"program": "'//program_name//'", '
    character(len=:), allocatable :: words
    integer :: k, at, length

    allocate (names(0))
    if (.not. is_plain_file(path)) return
    call read_text(path, words)
    if (index(words, beginning) /= 1 .or. index(words, '"deck": '// &
      json_value(file_name(folder))) == 0) return
    do k = 1, size(keys)
      ! The names of tables are words; warnings may speak of files, too, but before them.
      at = index(words, '"tables": [')
      do while (at > 0)
        length = index(words(at:), trim(keys(k)))
        if (length == 0) exit
        at = at + length - 1 + len_trim(keys(k))
        length = index(words(at:), '"') - 1
        if (length > 0) call append_string(names, words(at:at + length - 1))
      end do
    end do
    call append_string(names, echo_name)
    call append_string(names, log_name)
    call append_string(names, summary_name)
  end subroutine names_of_summary

  !> Lets the lock go.
  subroutine leave_folder(folder)
    type(output_folder_t), intent(inout) :: folder !! opened, or not

    call leave_lock(folder%lock)
  end subroutine leave_folder

  !> Removes the files of this run, and the folders that it made. Files of an earlier run stay.
  subroutine discard_folder(folder)
    type(output_folder_t), intent(inout) :: folder !! opened, as far as was possible, or not

    integer :: i

    if (allocated(folder%own)) call remove_directory(folder%own)
    call leave_lock(folder%lock)
    if (.not. allocated(folder%is_new)) return
    do i = size(folder%is_new), 1, -1
      call remove_empty_directory(folder%is_new(i)%text)
    end do
  end subroutine discard_folder

end module output_folders
