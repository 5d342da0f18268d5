!> The check of all variants of a deck before any is computed. A task reads and checks a block of
!! variants; what they leave is joined in their order.
!!
!! Variants with wrong values, and those that do not reach some position, are no errors of the deck
!! as long as others are sound: their rows are failed ones. A deck is refused if its variants cannot
!! be in one table, and if none is sound.
module variant_checks
  use available_memory, only: available_memory_t
  use byte_streams, only: get_integers, get_reals, get_string, put_integers, put_reals, put_string
  use card_bytes, only: get_token, put_token
  use cards, only: card_t
  use deck_card_bytes, only: get_deck_cards, put_deck_cards
  use deck_source, only: source_t
  use diagnostic_bytes, only: get_diagnostics, put_diagnostics
  use diagnostics, only: add_error, add_warning, append_warnings, count_warnings, diagnostic_t, &
    diagnostics_t, errors_of, has_errors, has_messages, has_other_errors, join_warnings
  use errors, only: error_of_memory, error_of_reach, error_of_writing
  use interruption, only: was_interrupted
  use jobs, only: job_t
  use kinds, only: wp
  use models, only: model_t
  use pauses, only: let_others_run
  use rank_tasks, only: help_with_tasks
  use ranks, only: rank_count
  use study_parts, only: first_variant, last_variant, part_t
  use task_journal, only: journal_t
  use tasks, only: run_tasks
  use text, only: string_t, to_string
  use text_buffer, only: text_buffer_t
  use tokens, only: token_t
  use variant_readings, only: check_variant, read_variant
  use variants, only: deck_cards_t, variant_count, variant_text
  implicit none (type, external)
  private

  public :: check_job_t, check_variants, begin_checks, conclude_checks, verdict_t, is_refused
  public :: help_with_checks, checks_announced

  !> What the check of a variant leaves.
  type :: checked_variant_t
    integer :: modes = 0               !! of its model; 0 if that is not complete
    integer :: effects = 0             !! likewise
    type(token_t) :: modes_word        !! on its MODES card
    type(diagnostics_t) :: diagnostics !! of this variant alone
  end type checked_variant_t

  !> Variants that a task checks.
  type :: block_t
    type(checked_variant_t), allocatable :: variants(:)
  end type block_t

  !> What the checks of all variants come to.
  type :: verdict_t
    integer :: threads = 1             !! for which they were made, and with how much memory
    type(available_memory_t) :: available
    integer :: leading = 0             !! number of the first variant that is not refused; 0: none
    integer, allocatable :: refused(:) !! (at least refused_count) numbers of the variants that
                                       !! cannot be computed, ascending
    integer :: refused_count = 0
    integer :: short = 0               !! variants that do not reach all positions
    integer :: unlike = 0              !! variants that cannot be in one table with the leading
                                       !! one, or for which there is too little memory
    integer :: last_unlike = 0         !! number of the last of these
  end type verdict_t

  !> The variants under way.
  type, extends(job_t) :: check_job_t
    type(deck_cards_t), pointer, private :: deck_cards => null()
    type(card_t), allocatable, private :: cards(:)       !! of the variant read last
    type(block_t), allocatable, private :: blocks(:)     !! (tasks) not yet joined
    integer, private :: first = 1, last = 0              !! variants to be computed: what others
                                                         !! leave is not told
    integer, private :: modes = 0, effects = 0           !! of the leading variant
    type(verdict_t), private :: verdict
    logical, private :: any_sound = .false.              !! some variant has no error at all
    type(diagnostics_t), private :: warnings             !! of the deck and of all variants
    type(diagnostics_t), private :: failures             !! what keeps variants from being computed,
                                                         !! as warnings
    type(diagnostics_t), private :: of_first             !! of the first variant
    type(diagnostics_t), private :: unlike               !! errors of the first that is unlike the
                                                         !! leading one
  contains
    procedure :: run => check_block
    procedure :: pack => pack_block
    procedure :: unpack => unpack_block
    procedure :: finish => join_block
  end type check_job_t

  !> Kinds of the warnings about variants with positions out of reach, and about those that cannot
  !! be computed, apart from other warnings at the same word.
  integer, parameter :: warning_of_reach = 1, warning_of_refusal = 3

  integer, parameter :: variants_at_a_time = 64

  !> First word of what other ranks are told.
  character(len=*), parameter :: checks_announced = "checks"

contains

  !> Reads and checks all variants of a deck, or those of a part and the one that leads.
  !!
  !! Errors: variants that cannot be in one table, the first of them in full and the others counted;
  !! if no variant is sound, or all have the errors of the first one, these.
  subroutine check_variants(deck_cards, source, threads, available, diagnostics, verdict, part)
    type(deck_cards_t), intent(in), target :: deck_cards !! without errors
    type(source_t), intent(in) :: source                 !! of the deck
    integer, intent(in) :: threads                       !! that will compute the deck
    type(available_memory_t), intent(in) :: available    !! at present
    type(diagnostics_t), intent(inout) :: diagnostics    !! of the deck, to which those of the
                                                         !! variants are added
    type(verdict_t), intent(out) :: verdict              !! holds if there are no errors, and if the
                                                         !! run was not interrupted
    type(part_t), intent(in), optional :: part           !! that will be computed; absent: all

    type(check_job_t) :: job
    type(journal_t) :: no_journal
    type(diagnostics_t) :: first
    type(model_t) :: model
    type(text_buffer_t) :: bytes
    integer :: blocks, next

    ! Of a million variants, a misspelt name would be told minutes later.
    call read_variant(deck_cards, 1, job%cards, first, model)
    if (is_written_wrongly(first)) then
      call append_warnings(diagnostics, first)
      call take_errors(first, "", diagnostics)
      return
    end if
    call begin_checks(job, deck_cards, threads, available, diagnostics, blocks)
    if (rank_count() > 1) then
      call put_string(bytes, checks_announced)
      call put_deck_cards(bytes, source, deck_cards)
      call put_integers(bytes, [threads])
      call put_reals(bytes, [available%bytes])
      call put_string(bytes, available%clause)
      job%announcement = bytes%storage(:bytes%length)
    end if
    ! One thread: it makes texts, and gfortran 12 keeps the lengths of such results in one place for
    ! all threads.
    next = 1
    if (present(part)) then
      job%first = first_variant(part, variant_count(deck_cards))
      job%last = last_variant(part, variant_count(deck_cards))
      ! Heads and texts are those of the variant that leads, which may be in another part.
      ! Where none is sound, the whole study is refused.
      do while (.not. job%any_sound .and. next <= blocks)
        call run_tasks(job, next, next, 1, no_journal, -1)
        next = next + 1
        if (was_interrupted()) return
      end do
      next = max(next, block_of(job%first))
      blocks = block_of(job%last)
    end if
    call run_tasks(job, next, blocks, 1, no_journal, -1)
    ! Of some variants nothing is known then.
    if (was_interrupted()) return
    call conclude_checks(job, diagnostics, verdict)
  end subroutine check_variants

  !> Helps the leader with the checks that it has announced.
  subroutine help_with_checks(bytes, at, settings)
    character(len=*), intent(in) :: bytes     !! that announce them
    integer, intent(inout) :: at              !! place of the first byte; on return, after the last
    type(string_t), intent(in) :: settings(:) !! of the command line

    type(check_job_t) :: job
    type(deck_cards_t), target :: deck_cards
    type(source_t) :: source
    type(available_memory_t) :: available
    type(diagnostics_t) :: none
    integer :: threads(1), blocks
    real(wp) :: memory(1)

    call get_deck_cards(bytes, at, settings, source, deck_cards)
    call get_integers(bytes, at, threads)
    call get_reals(bytes, at, memory)
    available%bytes = memory(1)
    call get_string(bytes, at, available%clause)
    call begin_checks(job, deck_cards, threads(1), available, none, blocks)
    call help_with_tasks(job, 1)
  end subroutine help_with_checks

  !> Makes a job of the checks: its tasks are the blocks.
  subroutine begin_checks(job, deck_cards, threads, available, diagnostics, blocks)
    type(check_job_t), intent(inout) :: job              !! new, or with cards of a variant
    type(deck_cards_t), intent(in), target :: deck_cards !! without errors
    integer, intent(in) :: threads                       !! that will compute the deck
    type(available_memory_t), intent(in) :: available    !! at present
    type(diagnostics_t), intent(in) :: diagnostics       !! of the deck
    integer, intent(out) :: blocks                       !! number of tasks

    blocks = block_of(variant_count(deck_cards))
    job%last = variant_count(deck_cards)
    job%deck_cards => deck_cards
    job%verdict%threads = threads
    job%verdict%available = available
    job%warnings = diagnostics
    allocate (job%blocks(blocks), job%verdict%refused(16))
  end subroutine begin_checks

  !> Whether a variant cannot be computed.
  pure function is_refused(verdict, number) result(is)
    type(verdict_t), intent(in) :: verdict !! on all variants of a deck
    integer, intent(in) :: number          !! of the variant
    logical :: is

    integer :: low, high, middle

    ! Between the two there is the first that is not below the number.
    low = 0
    high = verdict%refused_count + 1
    do while (high - low > 1)
      middle = (low + high)/2
      if (verdict%refused(middle) < number) then
        low = middle
      else
        high = middle
      end if
    end do
    is = high <= verdict%refused_count
    if (is) is = verdict%refused(high) == number
  end function is_refused

  !> Whether a variant has errors, and none of them depends on what varies.
  pure function is_written_wrongly(diagnostics) result(is)
    type(diagnostics_t), intent(in) :: diagnostics !! of the variant
    logical :: is

    type(diagnostic_t), allocatable :: list(:)
    integer :: i

    list = errors_of(diagnostics)
    is = size(list) > 0 .and. .not. has_other_errors(diagnostics, error_of_writing)
    do i = 1, size(list)
      is = is .and. list(i)%place%set_line == 0
    end do
  end function is_written_wrongly

  !> Number of the block that has a variant.
  pure integer function block_of(number)
    integer, intent(in) :: number !! of the variant

    block_of = (number - 1)/variants_at_a_time + 1
  end function block_of

  !> Whether some error is at a value that SET or VARY gives.
  pure function is_at_value(diagnostics) result(is)
    type(diagnostics_t), intent(in) :: diagnostics !! of the variant
    logical :: is

    type(diagnostic_t), allocatable :: list(:)
    integer :: i

    list = errors_of(diagnostics)
    is = any([(list(i)%place%set_line /= 0, i=1, size(list))])
  end function is_at_value

  !> Numbers of the first and the last variant of a block.
  pure function limits_of(self, number) result(limits)
    type(check_job_t), intent(in) :: self
    integer, intent(in) :: number !! of the block
    integer :: limits(2)

    limits(1) = (number - 1)*variants_at_a_time + 1
    limits(2) = min(number*variants_at_a_time, variant_count(self%deck_cards))
  end function limits_of

  !> Reads and checks the variants of a block.
  subroutine check_block(self, number)
    class(check_job_t), intent(inout) :: self
    integer, intent(in) :: number !! of the block

    type(model_t) :: model
    integer :: limits(2), i

    limits = limits_of(self, number)
    allocate (self%blocks(number)%variants(limits(1):limits(2)))
    do i = limits(1), limits(2)
      associate (checked => self%blocks(number)%variants(i))
        ! Another thread may join blocks that other ranks have checked.
        !$omp critical (one_at_a_time)
        call read_variant(self%deck_cards, i, self%cards, checked%diagnostics, model)
        if (.not. has_errors(checked%diagnostics)) then
          checked%modes = model%modes
          checked%effects = model%effects
          checked%modes_word = model%modes_word
        end if
        call check_variant(model, self%verdict%threads, self%verdict%available, &
          checked%diagnostics)
        !$omp end critical (one_at_a_time)
        call let_others_run()
      end associate
    end do
  end subroutine check_block

  !> Appends what the variants of a block leave as bytes.
  subroutine pack_block(self, number, bytes)
    class(check_job_t), intent(in) :: self
    integer, intent(in) :: number !! of the block
    type(text_buffer_t), intent(inout) :: bytes

    integer :: i

    associate (variants => self%blocks(number)%variants)
      do i = lbound(variants, 1), ubound(variants, 1)
        call put_integers(bytes, [variants(i)%modes, variants(i)%effects])
        call put_token(bytes, variants(i)%modes_word)
        call put_diagnostics(bytes, variants(i)%diagnostics)
      end do
    end associate
  end subroutine pack_block

  !> Reads what `pack_block` wrote.
  subroutine unpack_block(self, number, bytes)
    class(check_job_t), intent(inout) :: self
    integer, intent(in) :: number !! of the block
    character(len=*), intent(in) :: bytes

    integer :: limits(2), numbers(2), at, i

    limits = limits_of(self, number)
    allocate (self%blocks(number)%variants(limits(1):limits(2)))
    at = 1
    do i = limits(1), limits(2)
      associate (checked => self%blocks(number)%variants(i))
        call get_integers(bytes, at, numbers)
        checked%modes = numbers(1)
        checked%effects = numbers(2)
        call get_token(bytes, at, checked%modes_word)
        call get_diagnostics(bytes, at, checked%diagnostics)
      end associate
    end do
  end subroutine unpack_block

  !> Joins the variants of a block to those before.
  subroutine join_block(self, number)
    class(check_job_t), intent(inout) :: self
    integer, intent(in) :: number !! of the block

    integer :: limits(2), i

    limits = limits_of(self, number)
    do i = limits(1), limits(2)
      call join_variant(self, i, self%blocks(number)%variants(i))
    end do
    deallocate (self%blocks(number)%variants)
  end subroutine join_block

  subroutine join_variant(self, number, checked)
    class(check_job_t), intent(inout) :: self
    integer, intent(in) :: number !! of the variant
    type(checked_variant_t), intent(in) :: checked

    character(len=:), allocatable :: name
    logical :: is_told

    is_told = number >= self%first .and. number <= self%last
    if (number == 1) self%of_first = checked%diagnostics
    ! Nearly all variants have nothing to say, and do not need their names.
    name = ""
    if (has_messages(checked%diagnostics)) name = variant_text(self%deck_cards, number)
    if (is_told) call join_warnings(self%warnings, checked%diagnostics, name)
    self%any_sound = self%any_sound .or. .not. has_errors(checked%diagnostics)
    if (lacks_memory(checked%diagnostics)) then
      ! What a machine has must not make rows: other machines would make others.
      if (is_told) call refuse_deck(self, number)
      if (is_told .and. self%verdict%unlike == 1) call take_errors(checked%diagnostics, &
        "with "//name//": ", self%unlike)
      return
    end if
    if (has_other_errors(checked%diagnostics, error_of_reach)) then
      if (.not. is_told) return
      call take_refused(self%verdict, number)
      call join_failures(self%failures, checked%diagnostics, name, warning_of_refusal)
      return
    end if
    if (is_told .and. has_errors(checked%diagnostics)) then
      self%verdict%short = self%verdict%short + 1
      call join_failures(self%failures, checked%diagnostics, name, warning_of_reach)
    end if
    if (self%verdict%leading == 0) then
      self%verdict%leading = number
      self%modes = checked%modes
      self%effects = checked%effects
    end if
    if (checked%modes == self%modes .and. checked%effects == self%effects) return
    if (.not. is_told) return
    call refuse_deck(self, number)
    if (self%verdict%unlike > 1) return
    name = variant_text(self%deck_cards, number)
    if (checked%modes /= self%modes) then
      call add_error(self%unlike, checked%modes_word, "with "//name//": "// &
        "all variants must have as many modes: they are columns of one table")
    else
      call add_error(self%unlike, self%deck_cards%variations(1)%name, "with "//name//": "// &
        "of this variant and the first one, one stands still without "// &
        "loads and one does not: EFFECTS must say whether axial forces act")
    end if
  end subroutine join_variant

  !> Notes a variant for which the deck is refused.
  pure subroutine refuse_deck(self, number)
    class(check_job_t), intent(inout) :: self
    integer, intent(in) :: number !! of the variant

    self%verdict%unlike = self%verdict%unlike + 1
    self%verdict%last_unlike = number
  end subroutine refuse_deck

  !> Whether there is too little memory for a variant.
  pure function lacks_memory(diagnostics) result(lacks)
    type(diagnostics_t), intent(in) :: diagnostics !! of the variant
    logical :: lacks

    lacks = has_errors(diagnostics)
    if (lacks) lacks = .not. has_other_errors(diagnostics, error_of_memory)
  end function lacks_memory

  !> Notes a variant that cannot be computed.
  pure subroutine take_refused(verdict, number)
    type(verdict_t), intent(inout) :: verdict
    integer, intent(in) :: number !! of the variant

    integer, allocatable :: larger(:)

    if (verdict%refused_count == size(verdict%refused)) then
      allocate (larger(2*size(verdict%refused)))
      larger(:verdict%refused_count) = verdict%refused
      call move_alloc(larger, verdict%refused)
    end if
    verdict%refused_count = verdict%refused_count + 1
    verdict%refused(verdict%refused_count) = number
  end subroutine take_refused

  !> Turns the errors of a variant that cannot be computed, or not at all positions, into warnings,
  !! and joins them to those of the variants before.
  subroutine join_failures(failures, mine, variant, kind)
    type(diagnostics_t), intent(inout) :: failures
    type(diagnostics_t), intent(in) :: mine
    character(len=*), intent(in) :: variant
    integer, intent(in) :: kind

    type(diagnostics_t) :: warnings
    type(diagnostic_t), allocatable :: list(:)
    character(len=:), allocatable :: message
    integer :: i

    list = errors_of(mine)
    do i = 1, size(list)
      message = "rows will be marked as failed: "//list(i)%message
      if (len(list(i)%note) > 0 .and. kind == warning_of_refusal) then
        call add_warning(warnings, list(i)%place, message, kind, second_place= &
          list(i)%second_place, note=list(i)%note)
      else
        call add_warning(warnings, list(i)%place, message, kind)
      end if
    end do
    call join_warnings(failures, warnings, variant)
  end subroutine join_failures

  !> Adds what all variants have left to the messages of the deck.
  subroutine conclude_checks(job, diagnostics, verdict)
    type(check_job_t), intent(in) :: job              !! with all blocks joined
    type(diagnostics_t), intent(inout) :: diagnostics !! as given to `begin_checks`
    type(verdict_t), intent(out) :: verdict           !! holds if there are no errors

    integer :: count !! of variants
    logical :: none_sound

    verdict = job%verdict
    count = job%last - job%first + 1
    none_sound = verdict%refused_count + verdict%short == count
    if (count < variant_count(job%deck_cards)) then
      ! A part of which no variant is sound may be one of a study that makes sense.
      none_sound = .not. job%any_sound
      if (none_sound) count = variant_count(job%deck_cards)
    end if
    if (none_sound .and. has_other_errors(job%of_first, error_of_reach)) then
      ! As a rule it is the deck that is wrong, not this variant.
      call append_warnings(diagnostics, job%of_first)
      call take_errors(job%of_first, "", diagnostics)
      if (is_at_value(job%of_first)) call count_refused(count, count)
      return
    end if
    diagnostics = job%warnings
    if (verdict%unlike == 0 .and. .not. none_sound) call append_warnings(diagnostics, &
      job%failures)
    call count_warnings(diagnostics, count)
    if (verdict%unlike > 0) then
      call take_errors(job%unlike, "", diagnostics)
      call count_refused(verdict%unlike, verdict%last_unlike)
    else if (none_sound) then
      call take_errors(job%of_first, "with "//variant_text(job%deck_cards, 1)//": ", diagnostics)
      call count_refused(count, count)
    end if

  contains

    !> Says how many variants are refused, if there is more than the one that has been told of.
    subroutine count_refused(refused, last)
      integer, intent(in) :: refused !! number of them
      integer, intent(in) :: last    !! number of the last one

      if (refused == 1) return
      call add_error(diagnostics, job%deck_cards%variations(1)%name, to_string(refused)//" of "// &
        to_string(count)//" variants are refused, the last one with "// &
        variant_text(job%deck_cards, last))
    end subroutine count_refused

  end subroutine conclude_checks

  !> Adds errors, each after a few words.
  subroutine take_errors(mine, before, diagnostics)
    type(diagnostics_t), intent(in) :: mine
    character(len=*), intent(in) :: before !! `with L=90mm: `, or empty
    type(diagnostics_t), intent(inout) :: diagnostics

    type(diagnostic_t), allocatable :: list(:)
    integer :: i

    list = errors_of(mine)
    do i = 1, size(list)
      if (len(list(i)%note) > 0) then
        call add_error(diagnostics, list(i)%place, before//list(i)%message, &
          list(i)%second_place, list(i)%note, list(i)%kind)
      else
        call add_error(diagnostics, list(i)%place, before//list(i)%message, kind=list(i)%kind)
      end if
    end do
  end subroutine take_errors

end module variant_checks
