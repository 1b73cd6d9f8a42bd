pln(16)         g12<1>F         g6<0,1,0>F      g2<8,8,1>F      { align1 1H compacted };
pln(16)         g14<1>F         g6.4<0,1,0>F    g2<8,8,1>F      { align1 1H compacted };
pln(16)         g16<1>F         g7<0,1,0>F      g2<8,8,1>F      { align1 1H compacted };
pln(16)         g120<1>F        g8<0,1,0>F      g2<8,8,1>F      { align1 1H compacted };
pln(16)         g122<1>F        g8.4<0,1,0>F    g2<8,8,1>F      { align1 1H compacted };
pln(16)         g124<1>F        g9<0,1,0>F      g2<8,8,1>F      { align1 1H compacted };
mov(1)          g31<1>D         1090519040D                     { align1 WE_all 1N };
mov(16)         g32<1>UD        g0<8,8,1>UD                     { align1 WE_all 1H compacted };
cmp.g.f0.0(16)  null<1>F        g16<8,8,1>F     0xbf800000F  /* -1F */ { align1 1H switch };
mad(16)         g20<1>F         g31.0<0,1,0>F   g16<4,4,1>F     g31.0<0,1,0>F { align16 1H };
math rsq(16)    g22<1>F         g20<8,8,1>F     null<8,8,1>F    { align1 1H compacted };
mul(16)         g24<1>F         g22<8,8,1>F     0x40000000F  /* 2F */ { align1 1H };
mul(16)         g26<1>F         g12<8,8,1>F     g24<8,8,1>F     { align1 1H compacted };
mul(16)         g28<1>F         g14<8,8,1>F     g24<8,8,1>F     { align1 1H compacted };
(+f0.0) sel(16) g34<1>UD        g26<8,8,1>UD    0x3f800000UD    { align1 1H };
(+f0.0) sel(16) g36<1>UD        g28<8,8,1>UD    0x00000000UD    { align1 1H compacted };
sendc(16)       null<1>UW       g32<8,8,1>UD    0x140b0000
                            render MsgDesc: RT write SIMD16 Surface = 0 mlen 10 rlen 0 { align1 1H };
mov(16)         g10<1>UD        g0<8,8,1>UD                     { align1 WE_all 1H compacted };
mov(1)          g10.2<1>UD      0x00000001UD                    { align1 WE_all 1N compacted };
sendc(16)       null<1>UW       g10<8,8,1>UD    0x140b0001
                            render MsgDesc: RT write SIMD16 Surface = 1 mlen 10 rlen 0 { align1 1H };
mov(16)         g118<1>UD       g0<8,8,1>UD                     { align1 WE_all 1H compacted };
mov(1)          g118.2<1>UD     0x00000002UD                    { align1 WE_all 1N compacted };
sendc(16)       null<1>UW       g118<8,8,1>UD   0x940b1002
                            render MsgDesc: RT write SIMD16 LastRT Surface = 2 mlen 10 rlen 0 { align1 1H EOT };
