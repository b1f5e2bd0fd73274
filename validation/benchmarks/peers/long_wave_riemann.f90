! Riemann solver of the annular long-wave equations for PyClaw: f-waves of Roe's kind.
!
! A_t + (u L)_theta = 0,  q_t + (u^2 (L + A/r^2)/2)_theta + A (B)_theta = 0,  B = A - r f
! with q = u A - A^2, r = sqrt(1 - 2 A), L = -log(r); lengths over R, times over 1/Omega. The jump of the
! static head B carries the body force f, so that a layer at rest in it stays at rest.
! Unknowns: A, q. Auxiliary field: f at the cells' middles.
subroutine rp1(maxm, num_eqn, num_waves, num_aux, num_ghost, num_cells, &
               ql, qr, auxl, auxr, fwave, s, amdq, apdq)
    implicit none
    integer, intent(in) :: maxm, num_eqn, num_waves, num_aux, num_ghost, num_cells
    real(kind=8), intent(in), dimension(num_eqn, 1-num_ghost:maxm+num_ghost) :: ql, qr
    real(kind=8), intent(in), dimension(num_aux, 1-num_ghost:maxm+num_ghost) :: auxl, auxr
    real(kind=8), intent(out) :: fwave(num_eqn, num_waves, 1-num_ghost:maxm+num_ghost)
    real(kind=8), intent(out) :: s(num_waves, 1-num_ghost:maxm+num_ghost)
    real(kind=8), intent(out), dimension(num_eqn, 1-num_ghost:maxm+num_ghost) :: amdq, apdq
    integer :: i, k
    real(kind=8) :: a, u, r2, l, carried, turning, swing, jump1, jump2, y1, y2, share
    real(kind=8), dimension(1-num_ghost:maxm+num_ghost) :: mass, flow, head, speed

    ! One state a cell: the values at both of its sides are the same here.
    do i = 1-num_ghost, num_cells+num_ghost
        a = ql(1, i)
        r2 = 1.d0 - 2.d0*a
        l = -0.5d0*log(r2)
        u = ql(2, i)/a + a
        speed(i) = u
        mass(i) = u*l
        flow(i) = 0.5d0*u*u*(l + a/r2)
        head(i) = a - sqrt(r2)*auxl(1, i)
    end do
    do i = 2-num_ghost, num_cells+num_ghost
        a = 0.5d0*(ql(1, i) + qr(1, i-1))
        u = 0.5d0*(speed(i) + speed(i-1))
        r2 = 1.d0 - 2.d0*a
        l = -0.5d0*log(r2)
        turning = u/r2
        carried = l
        swing = sqrt(carried*carried + l*(1.d0 + turning)**2)
        s(1, i) = turning + carried - swing
        s(2, i) = turning + carried + swing
        jump1 = mass(i) - mass(i-1)
        jump2 = flow(i) - flow(i-1) + a*(head(i) - head(i-1))
        ! Eigenvectors (1, y): d(u L)/dA + y L/a = speed at constant q.
        y1 = a*(s(1, i) - turning)/l + u - 2.d0*a
        y2 = a*(s(2, i) - turning)/l + u - 2.d0*a
        share = (jump2 - y1*jump1)/(y2 - y1)
        fwave(1, 1, i) = jump1 - share
        fwave(2, 1, i) = (jump1 - share)*y1
        fwave(1, 2, i) = share
        fwave(2, 2, i) = share*y2
        amdq(:, i) = 0.d0
        apdq(:, i) = 0.d0
        do k = 1, 2
            if (s(k, i) < 0.d0) then
                amdq(:, i) = amdq(:, i) + fwave(:, k, i)
            else
                apdq(:, i) = apdq(:, i) + fwave(:, k, i)
            end if
        end do
    end do
end subroutine rp1
