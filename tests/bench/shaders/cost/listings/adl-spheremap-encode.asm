mov(8)          g11<1>F         g2<8,8,1>F                      { align1 WE_all 1Q compacted };
mov(8)          g12<1>F         g4<8,8,1>F                      { align1 WE_all 1Q compacted };
mov(8)          g40<1>F         g3<8,8,1>F                      { align1 WE_all 1Q compacted };
mov(8)          g41<1>F         g5<8,8,1>F                      { align1 WE_all 1Q compacted };
mov(1)          g13<1>D         1090519040D                     { align1 WE_all 1N };
sync nop(1)                     null<0,1,0>UB                   { align1 WE_all 1N @2 };
mad(16)         g18<1>F         g6.3<0,1,0>F    g6.1<0,1,0>F    g40<1,1,1>F { align1 1H };
mad(16)         g20<1>F         g6.7<0,1,0>F    g6.5<0,1,0>F    g40<1,1,1>F { align1 1H };
mad(16)         g22<1>F         g7.3<0,1,0>F    g7.1<0,1,0>F    g40<1,1,1>F { align1 1H };
mad(16)         g24<1>F         g8.3<0,1,0>F    g8.1<0,1,0>F    g40<1,1,1>F { align1 1H };
mad(16)         g26<1>F         g8.7<0,1,0>F    g8.5<0,1,0>F    g40<1,1,1>F { align1 1H };
mad(16)         g28<1>F         g9.3<0,1,0>F    g9.1<0,1,0>F    g40<1,1,1>F { align1 1H };
sync nop(1)                     null<0,1,0>UB                   { align1 WE_all 1N @6 };
mad(16)         g39<1>F         g18<8,8,1>F     g6.0<0,1,0>F    g11<1,1,1>F { align1 1H compacted };
mad(16)         g41<1>F         g20<8,8,1>F     g6.4<0,1,0>F    g11<1,1,1>F { align1 1H @6 compacted };
mad(16)         g43<1>F         g22<8,8,1>F     g7.0<0,1,0>F    g11<1,1,1>F { align1 1H @6 compacted };
mad(16)         g119<1>F        g24<8,8,1>F     g8.0<0,1,0>F    g11<1,1,1>F { align1 1H @6 compacted };
mad(16)         g121<1>F        g26<8,8,1>F     g8.4<0,1,0>F    g11<1,1,1>F { align1 1H @6 compacted };
mad(16)         g123<1>F        g28<8,8,1>F     g9.0<0,1,0>F    g11<1,1,1>F { align1 1H @6 compacted };
sync nop(1)                     null<0,1,0>UB                   { align1 WE_all 1N @4 };
mad(16)         g29<1>F         0x4800HF        g43<8,8,1>F     g13.0<0,1,0>F { align1 1H };
cmp.g.f0.0(16)  null<1>F        g43<8,8,1>F     0xbf800000F  /* -1F */ { align1 1H compacted };
math rsq(16)    g31<1>F         g29<8,8,1>F     null<8,8,1>F    { align1 1H @2 $0 };
mul(16)         g33<1>F         g31<8,8,1>F     0x40000000F  /* 2F */ { align1 1H $0.dst compacted };
mul(16)         g35<1>F         g39<8,8,1>F     g33<8,8,1>F     { align1 1H @1 compacted };
mul(16)         g37<1>F         g41<8,8,1>F     g33<8,8,1>F     { align1 1H @7 compacted };
(+f0.0) sel(16) g10<1>UD        g35<8,8,1>UD    0x3f800000UD    { align1 1H @2 };
(+f0.0) sel(16) g12<1>UD        g37<8,8,1>UD    0x00000000UD    { align1 1H @2 compacted };
sendc(16)       nullUD          g10UD           nullUD          0x10030000                0x00000000
                            render MsgDesc: RT write SIMD16 Surface = 0 mlen 8 ex_mlen 0 rlen 0 { align1 1H @1 $1 };
sendc(16)       nullUD          g39UD           nullUD          0x10030001                0x00001000
                            render MsgDesc: RT write SIMD16 Surface = 1 mlen 8 ex_mlen 0 rlen 0 { align1 1H $2 };
sendc(16)       nullUD          g119UD          nullUD          0x10031002                0x00002000
                            render MsgDesc: RT write SIMD16 LastRT Surface = 2 mlen 8 ex_mlen 0 rlen 0 { align1 1H @1 EOT };
